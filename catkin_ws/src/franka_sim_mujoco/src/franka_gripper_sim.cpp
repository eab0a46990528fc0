// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim_mujoco/franka_gripper_sim.h>
#include <ros/console.h>

#include <pluginlib/class_list_macros.hpp>
#include <stdexcept>

#include "arm_parameters.h"
#include "param_reader.h"
#include "service_handlers.h"

namespace franka_sim_mujoco {

namespace {

constexpr char kGripperLog[] = "franka_gripper_sim";
constexpr double kPublishRate = 30.0;  ///< [Hz]

std::string readArmId(const ros::NodeHandle& node) {
  const auto arm_id = readString(node, "arm_id");
  if (!arm_id || arm_id->empty()) {
    throw std::invalid_argument("The parameter " + node.resolveName("arm_id") +
                                " is missing; it must be the prefix of the finger joints' names.");
  }
  return *arm_id;
}

franka_sim::FingerGains readGains(const ros::NodeHandle& node, const std::string& finger) {
  const auto p = readNumber(node, finger + "/gains/p");
  if (!p) {
    throw std::invalid_argument("The parameter " + node.resolveName(finger + "/gains/p") +
                                " is missing: the proportional gain of the finger [N/m].");
  }
  franka_sim::FingerGains gains;
  gains.p = *p;
  gains.i = readNumber(node, finger + "/gains/i").value_or(0.0);
  gains.d = readNumber(node, finger + "/gains/d").value_or(0.0);
  return gains;
}

double readPositive(const ros::NodeHandle& node, const std::string& name, double fallback) {
  const double value = readNumber(node, name).value_or(fallback);
  if (value <= 0.0) {
    throw std::invalid_argument("The parameter " + node.resolveName(name) + " is " +
                                franka_core::numberText(value) + "; it must be above 0.");
  }
  return value;
}

franka_sim::GripperParameters readUnitParameters(const ros::NodeHandle& node) {
  franka_sim::GripperParameters parameters;
  parameters.gains = {readGains(node, "finger1"), readGains(node, "finger2")};
  parameters.move_tolerance = readPositive(node, "move/width_tolerance", parameters.move_tolerance);
  parameters.resting_threshold =
      readPositive(node, "grasp/resting_threshold", parameters.resting_threshold);
  const double samples =
      readPositive(node, "grasp/consecutive_samples", parameters.consecutive_samples);
  const auto whole = franka_core::wholeNumber(samples, 1, 1000000);
  if (!whole) {
    throw std::invalid_argument("The parameter " + node.resolveName("grasp/consecutive_samples") +
                                " must be a whole number.");
  }
  parameters.consecutive_samples = static_cast<int>(*whole);
  std::string robot_type;  // hands are the same for both, so "panda" serves where it is not set
  parameters.latency = readPhysics(node,
                                   node.searchParam("robot_type", robot_type)
                                       ? readString(node, robot_type).value_or("panda")
                                       : "panda",
                                   franka_sim::kInProcessProfile)
                           .gripper;
  return parameters;
}

GripperActionParameters readActionParameters(const ros::NodeHandle& node, double max_width) {
  GripperActionParameters parameters;
  parameters.max_width = max_width;
  parameters.gripper_action_width_tolerance = readPositive(
      node, "gripper_action/width_tolerance", parameters.gripper_action_width_tolerance);
  parameters.gripper_action_speed =
      readPositive(node, "gripper_action/speed", parameters.gripper_action_speed);
  return parameters;
}

}  // namespace

bool FrankaGripperSim::init(hardware_interface::EffortJointInterface* hw, ros::NodeHandle& node) {
  try {
    const std::string arm_id = readArmId(node);
    const franka_sim::GripperParameters parameters = readUnitParameters(node);
    unit_.emplace(parameters);
    fingers_ = {hw->getHandle(arm_id + "_finger_joint1"), hw->getHandle(arm_id + "_finger_joint2")};
    publish_rate_.emplace(kPublishRate, ros::Time(0));
    joint_states_ = std::make_unique<realtime_tools::RealtimePublisher<sensor_msgs::JointState>>(
        node, "joint_states", 1);
    joint_states_->lock();
    sensor_msgs::JointState& message = joint_states_->msg_;
    message.name = {fingers_[0].getName(), fingers_[1].getName()};
    message.position.resize(2);
    message.velocity.resize(2);
    message.effort.resize(2);
    joint_states_->unlock();
    actions_ = std::make_unique<GripperActions>(
        node, readActionParameters(node, parameters.max_width), mailbox_, view_);
    return true;
  } catch (...) {
    // Includes HardwareInterfaceException for the fingers' handles.
    ROS_ERROR_NAMED(kGripperLog, "The gripper %s does not start: %s", node.getNamespace().c_str(),
                    exceptionText().c_str());
    return false;
  }
}

void FrankaGripperSim::starting(const ros::Time& time) {
  unit_->restart();
  mailbox_.interruptAll();  // commands posted while the controller was stopped
  publish_rate_.emplace(kPublishRate, time);
  view_.controller_runs = true;
}

void FrankaGripperSim::update(const ros::Time& time, const ros::Duration& period) {
  mailbox_.serve(*unit_);
  const std::array<double, 2> force = unit_->step(measure(), period.toSec());
  mailbox_.settle(*unit_);
  view_.width.store(unit_->width(), std::memory_order_relaxed);
  fingers_[0].setCommand(force[0]);
  fingers_[1].setCommand(force[1]);
  if ((*publish_rate_)(time)) {
    publish(time);
  }
}

void FrankaGripperSim::stopping(const ros::Time& /*time*/) {
  view_.controller_runs = false;
  mailbox_.interruptAll();
  for (hardware_interface::JointHandle& finger : fingers_) {
    finger.setCommand(0.0);
  }
}

franka_sim::HandMeasurement FrankaGripperSim::measure() const {
  franka_sim::HandMeasurement measurement;
  for (std::size_t i = 0; i < 2; ++i) {
    measurement.q[i] = fingers_[i].getPosition();
    measurement.dq[i] = fingers_[i].getVelocity();
  }
  return measurement;
}

void FrankaGripperSim::publish(const ros::Time& time) {
  if (!joint_states_->trylock()) {
    return;
  }
  sensor_msgs::JointState& message = joint_states_->msg_;
  message.header.stamp = time;
  for (std::size_t i = 0; i < 2; ++i) {
    message.position[i] = fingers_[i].getPosition();
    message.velocity[i] = fingers_[i].getVelocity();
    message.effort[i] = fingers_[i].getEffort();
  }
  joint_states_->unlockAndPublish();
}

}  // namespace franka_sim_mujoco

PLUGINLIB_EXPORT_CLASS(franka_sim_mujoco::FrankaGripperSim, controller_interface::ControllerBase)
