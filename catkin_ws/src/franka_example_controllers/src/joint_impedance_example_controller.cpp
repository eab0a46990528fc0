// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/joint_impedance_example_controller.h>
#include <franka_example_controllers/robot_handles.h>
#include <franka_example_controllers/torque_rate.h>
#include <pluginlib/class_list_macros.h>

#include <algorithm>
#include <cmath>

namespace franka_example_controllers {

namespace {

bool readPositive(const char* controller, const ros::NodeHandle& nh, const std::string& name,
                  double& value) {
  if (nh.hasParam(name) && !(nh.getParam(name, value) && std::isfinite(value) && value > 0.0)) {
    ROS_ERROR("%s: the parameter %s must be a number above zero.", controller,
              nh.resolveName(name).c_str());
    return false;
  }
  return true;
}

}  // namespace

bool JointImpedanceExampleController::init(hardware_interface::RobotHW* robot_hw,
                                           ros::NodeHandle& node_handle) {
  std::string arm_id;
  std::vector<std::string> joint_names;
  if (!readArmId(kName, node_handle, arm_id) || !readJointNames(kName, node_handle, joint_names) ||
      !readParameters(node_handle) || !takeHandles(kName, arm_id, [&] {
        model_handle_ = std::make_unique<franka_hw::FrankaModelHandle>(
            takeHandle<franka_hw::FrankaModelInterface>(robot_hw, arm_id + "_model"));
        pose_handle_ = std::make_unique<franka_hw::FrankaCartesianPoseHandle>(
            takeHandle<franka_hw::FrankaPoseCartesianInterface>(robot_hw, arm_id + "_robot"));
        joint_handles_ =
            takeJoints<hardware_interface::EffortJointInterface>(robot_hw, joint_names);
      })) {
    return false;
  }
  publisher_.init(node_handle, "torque_comparison", 1);
  return true;
}

bool JointImpedanceExampleController::readParameters(const ros::NodeHandle& node_handle) {
  if (!readGains(kName, node_handle, "k_gains", k_gains_) ||
      !readGains(kName, node_handle, "d_gains", d_gains_) ||
      !readPositive(kName, node_handle, "vel_max", vel_max_) ||
      !readPositive(kName, node_handle, "acceleration_time", acceleration_time_) ||
      !readPositive(kName, node_handle, "publish_rate", publish_rate_)) {
    return false;
  }
  node_handle.getParam("coriolis_factor", coriolis_factor_);
  node_handle.getParam("radius", radius_);
  if (!std::isfinite(coriolis_factor_)) {
    ROS_ERROR("%s: the parameter %s must be a number.", kName,
              node_handle.resolveName("coriolis_factor").c_str());
    return false;
  }
  if (!(std::abs(radius_) >= kMinRadius)) {
    ROS_INFO_STREAM(kName << ": a radius of " << radius_
                          << " m is too small for a circle; using 0.1 m.");
    radius_ = 0.1;
  }
  return true;
}

void JointImpedanceExampleController::starting(const ros::Time& time) {
  const franka::RobotState& state = pose_handle_->getRobotState();
  O_T_EE_start_ = state.O_T_EE_d;
  // A restart begins the circle from rest.
  angle_ = 0.0;
  velocity_ = 0.0;
  dq_filtered_ = state.dq;
  last_tau_ = state.tau_J_d;
  rate_ = franka_hw::TriggerRate(publish_rate_, time);
}

void JointImpedanceExampleController::update(const ros::Time& time, const ros::Duration& period) {
  leadAlongCircle(period.toSec());
  const franka::RobotState& state = pose_handle_->getRobotState();
  const std::array<double, 7> tau = saturateTorqueRate(torques(), state.tau_J_d);
  for (std::size_t i = 0; i < joint_handles_.size(); ++i) {
    joint_handles_[i].setCommand(tau[i]);
  }
  if (rate_(time)) {
    compare(state, time);
  }
  last_tau_ = tau;
}

void JointImpedanceExampleController::leadAlongCircle(double dt) {
  velocity_ = std::min(velocity_ + dt * std::abs(vel_max_ / acceleration_time_), vel_max_);
  angle_ = std::fmod(angle_ + dt * velocity_ / std::abs(radius_), kTwoPi);
  std::array<double, 16> pose = O_T_EE_start_;
  pose[13] += radius_ * (1.0 - std::cos(angle_));
  pose[14] += radius_ * std::sin(angle_);
  pose_handle_->setCommand(pose);
}

std::array<double, 7> JointImpedanceExampleController::torques() {
  const franka::RobotState& state = pose_handle_->getRobotState();
  const std::array<double, 7> coriolis = model_handle_->getCoriolis();
  std::array<double, 7> tau{};
  for (std::size_t i = 0; i < tau.size(); ++i) {
    dq_filtered_[i] = (1.0 - kVelocityShare) * dq_filtered_[i] + kVelocityShare * state.dq[i];
    tau[i] = coriolis_factor_ * coriolis[i] + k_gains_[i] * (state.q_d[i] - state.q[i]) +
             d_gains_[i] * (state.dq_d[i] - dq_filtered_[i]);
  }
  return tau;
}

void JointImpedanceExampleController::compare(const franka::RobotState& state,
                                              const ros::Time& /*time*/) {
  if (!publisher_.trylock()) {
    return;
  }
  const std::array<double, 7> gravity = model_handle_->getGravity();
  double sum = 0.0;
  for (std::size_t i = 0; i < gravity.size(); ++i) {
    // The measured torque is the command of the last cycle.
    const double commanded = last_tau_[i] + gravity[i];
    publisher_.msg_.tau_commanded[i] = commanded;
    publisher_.msg_.tau_measured[i] = state.tau_J[i];
    publisher_.msg_.tau_error[i] = commanded - state.tau_J[i];
    sum += std::abs(commanded - state.tau_J[i]);
  }
  publisher_.msg_.root_mean_square_error = sum / static_cast<double>(gravity.size());
  publisher_.unlockAndPublish();
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::JointImpedanceExampleController,
                       controller_interface::ControllerBase)
