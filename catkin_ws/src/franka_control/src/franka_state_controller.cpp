// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/robot_state.h>
#include <franka_control/franka_state_controller.h>
#include <franka_control/state_conversions.h>
#include <franka_core/numbers.h>
#include <hardware_interface/hardware_interface.h>
#include <hardware_interface/robot_hw.h>
#include <pluginlib/class_list_macros.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "state_publisher.h"

namespace franka_control {

namespace {

constexpr std::size_t kJoints = 7;
constexpr int kQueueSize = 1;  // only the newest state is queued, because old states are useless

/// Prepares a joint state of seven joints, so that the loop only has to write numbers.
void prepare(const std::vector<std::string>& joint_names, sensor_msgs::JointState& message) {
  message.name = joint_names;
  message.position.resize(kJoints);
  message.velocity.resize(kJoints);
  message.effort.resize(kJoints);
}

void fill(const std::array<double, kJoints>& position, const std::array<double, kJoints>& velocity,
          const std::array<double, kJoints>& effort, sensor_msgs::JointState& message) {
  std::copy(position.begin(), position.end(), message.position.begin());
  std::copy(velocity.begin(), velocity.end(), message.velocity.begin());
  std::copy(effort.begin(), effort.end(), message.effort.begin());
}

}  // namespace

FrankaStateController::FrankaStateController() = default;
FrankaStateController::~FrankaStateController() = default;

bool FrankaStateController::init(hardware_interface::RobotHW* robot_hardware,
                                 ros::NodeHandle& root_node_handle,
                                 ros::NodeHandle& controller_node_handle) {
  if (!readParameters(controller_node_handle) || !takeHandle(robot_hardware)) {
    return false;
  }
  trigger_ = franka_hw::TriggerRate(publish_rate_, ros::Time());
  createPublishers(root_node_handle, controller_node_handle);
  return true;
}

bool FrankaStateController::readParameters(const ros::NodeHandle& controller_node_handle) {
  const std::string& where = controller_node_handle.getNamespace();
  if (!controller_node_handle.getParam("arm_id", arm_id_) || arm_id_.empty()) {
    ROS_ERROR(
        "FrankaStateController: set the parameter %s/arm_id to the name of the arm, such as "
        "'panda'.",
        where.c_str());
    return false;
  }
  if (!controller_node_handle.getParam("joint_names", joint_names_) ||
      joint_names_.size() != kJoints) {
    ROS_ERROR(
        "FrankaStateController: the parameter %s/joint_names must be a list of the arm's seven "
        "joint names; it has %zu.",
        where.c_str(), joint_names_.size());
    return false;
  }
  publish_rate_ = 30.0;
  const bool is_given = controller_node_handle.hasParam("publish_rate");
  if (is_given && !controller_node_handle.getParam("publish_rate", publish_rate_)) {
    ROS_ERROR(
        "FrankaStateController: the parameter %s/publish_rate must be a number of messages per "
        "second [Hz].",
        where.c_str());
    return false;
  }
  if (!std::isfinite(publish_rate_) || publish_rate_ <= 0.0) {
    ROS_ERROR("FrankaStateController: the parameter %s/publish_rate must be above 0 Hz; it is %s.",
              where.c_str(), franka_core::numberText(publish_rate_).c_str());
    return false;
  }
  return true;
}

bool FrankaStateController::takeHandle(hardware_interface::RobotHW* robot_hardware) {
  auto* states = robot_hardware->get<franka_hw::FrankaStateInterface>();
  if (states == nullptr) {
    ROS_ERROR(
        "FrankaStateController: the robot offers no franka_hw::FrankaStateInterface; start the "
        "controller on the hardware of a Franka arm.");
    return false;
  }
  try {
    state_handle_ =
        std::make_unique<franka_hw::FrankaStateHandle>(states->getHandle(arm_id_ + "_robot"));
  } catch (const hardware_interface::HardwareInterfaceException& error) {
    ROS_ERROR("FrankaStateController: the robot has no arm '%s'; check the parameter arm_id. %s",
              arm_id_.c_str(), error.what());
    return false;
  }
  return true;
}

void FrankaStateController::createPublishers(const ros::NodeHandle& root_node_handle,
                                             const ros::NodeHandle& controller_node_handle) {
  const auto advertise = [](auto& publisher, const ros::NodeHandle& node, const char* topic) {
    using Realtime = std::remove_reference_t<decltype(*publisher)>;
    publisher = std::make_unique<Realtime>(node, topic, kQueueSize);
  };
  franka_state_publisher_ = std::make_unique<StatePublisher>(controller_node_handle,
                                                             "franka_states", 1.0 / publish_rate_);
  advertise(transforms_publisher_, root_node_handle, "/tf");
  advertise(external_wrench_publisher_, controller_node_handle, "F_ext");
  advertise(joint_states_publisher_, controller_node_handle, "joint_states");
  advertise(joint_states_desired_publisher_, controller_node_handle, "joint_states_desired");

  const std::array<std::string, 4> chain{
      {arm_id_ + "_link8", arm_id_ + "_NE", arm_id_ + "_EE", arm_id_ + "_K"}};
  auto& transforms = transforms_publisher_->msg_.transforms;
  transforms.resize(chain.size() - 1);
  for (std::size_t i = 0; i < transforms.size(); ++i) {
    transforms[i].header.frame_id = chain[i];
    transforms[i].child_frame_id = chain[i + 1];
  }
  external_wrench_publisher_->msg_.header.frame_id = chain.back();
  prepare(joint_names_, joint_states_publisher_->msg_);
  prepare(joint_names_, joint_states_desired_publisher_->msg_);
}

void FrankaStateController::starting(const ros::Time& time) {
  trigger_ = franka_hw::TriggerRate(publish_rate_, time);
}

void FrankaStateController::update(const ros::Time& time, const ros::Duration& /*period*/) {
  if (!trigger_(time)) {
    return;
  }
  publishFrankaState(time);
  publishTransforms(time);
  publishExternalWrench(time);
  publishJointStates(time);
  ++sequence_number_;
}

void FrankaStateController::publishFrankaState(const ros::Time& time) {
  franka_msgs::FrankaState* message = franka_state_publisher_->next();
  if (message == nullptr) {
    return;
  }
  toMessage(state_handle_->getRobotState(), *message);
  message->header.seq = sequence_number_;
  message->header.stamp = time;
  franka_state_publisher_->handOver();
}

void FrankaStateController::publishTransforms(const ros::Time& time) {
  if (!transforms_publisher_->trylock()) {
    return;
  }
  const franka::RobotState& state = state_handle_->getRobotState();
  auto& transforms = transforms_publisher_->msg_.transforms;
  transforms[0].transform = toTransform(state.F_T_NE);
  transforms[1].transform = toTransform(state.NE_T_EE);
  transforms[2].transform = toTransform(state.EE_T_K);
  for (auto& transform : transforms) {
    transform.header.seq = sequence_number_;
    transform.header.stamp = time;
  }
  transforms_publisher_->unlockAndPublish();
}

void FrankaStateController::publishExternalWrench(const ros::Time& time) {
  if (!external_wrench_publisher_->trylock()) {
    return;
  }
  const std::array<double, 6>& wrench = state_handle_->getRobotState().K_F_ext_hat_K;
  auto& message = external_wrench_publisher_->msg_;
  message.header.seq = sequence_number_;
  message.header.stamp = time;
  message.wrench.force.x = wrench[0];
  message.wrench.force.y = wrench[1];
  message.wrench.force.z = wrench[2];
  message.wrench.torque.x = wrench[3];
  message.wrench.torque.y = wrench[4];
  message.wrench.torque.z = wrench[5];
  external_wrench_publisher_->unlockAndPublish();
}

void FrankaStateController::publishJointStates(const ros::Time& time) {
  const franka::RobotState& state = state_handle_->getRobotState();
  const auto publish = [&](auto& publisher, const std::array<double, kJoints>& position,
                           const std::array<double, kJoints>& velocity,
                           const std::array<double, kJoints>& effort) {
    if (!publisher->trylock()) {
      return;
    }
    publisher->msg_.header.seq = sequence_number_;
    publisher->msg_.header.stamp = time;
    fill(position, velocity, effort, publisher->msg_);
    publisher->unlockAndPublish();
  };
  publish(joint_states_publisher_, state.q, state.dq, state.tau_J);
  publish(joint_states_desired_publisher_, state.q_d, state.dq_d, state.tau_J_d);
}

}  // namespace franka_control

PLUGINLIB_EXPORT_CLASS(franka_control::FrankaStateController, controller_interface::ControllerBase)
