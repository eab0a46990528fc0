// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <control_toolbox/pid.h>
#include <hardware_interface/joint_command_interface.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <algorithm>
#include <memory>

/// Converts a gripper's target into commands of a hardware interface; implemented for position and
/// effort. init() runs outside the control loop, all others in it: no allocation, no lock.
template <class HardwareInterface>
class HardwareInterfaceAdapter {
 public:
  bool init(typename HardwareInterface::ResourceHandleType& /*joint_handle*/,
            ros::NodeHandle& /*controller_nh*/) {
    return false;
  }
  void starting(const ros::Time& /*time*/) {}
  void stopping(const ros::Time& /*time*/) {}
  double updateCommand(const ros::Time& /*time*/, const ros::Duration& /*period*/,
                       double /*desired_position*/, double /*desired_velocity*/,
                       double /*error_position*/, double /*error_velocity*/,
                       double /*max_allowed_effort*/) {
    return 0.0;
  }
};

/// Commands the target position; the hardware controls the effort.
template <>
class HardwareInterfaceAdapter<hardware_interface::PositionJointInterface> {
 public:
  bool init(hardware_interface::JointHandle& joint_handle, ros::NodeHandle& /*controller_nh*/) {
    joint_ = &joint_handle;
    return true;
  }
  void starting(const ros::Time& /*time*/) { joint_->setCommand(joint_->getPosition()); }
  void stopping(const ros::Time& /*time*/) {}

  /// @returns the effort that the goal allows, because the real one is unknown
  double updateCommand(const ros::Time& /*time*/, const ros::Duration& /*period*/,
                       double desired_position, double /*desired_velocity*/,
                       double /*error_position*/, double /*error_velocity*/,
                       double max_allowed_effort) {
    joint_->setCommand(desired_position);
    return max_allowed_effort;
  }

 private:
  hardware_interface::JointHandle* joint_{nullptr};
};

/// Commands a PID of the position error, limited to the effort that the goal allows.
/// Parameters: `gains/<joint>` as for control_toolbox::Pid::init().
template <>
class HardwareInterfaceAdapter<hardware_interface::EffortJointInterface> {
 public:
  bool init(hardware_interface::JointHandle& joint_handle, ros::NodeHandle& controller_nh) {
    joint_ = &joint_handle;
    const ros::NodeHandle gains_nh(controller_nh, "gains/" + joint_handle.getName());
    pid_ = std::make_unique<control_toolbox::Pid>();
    if (!pid_->init(gains_nh)) {
      ROS_ERROR_STREAM("The controller has no usable PID gains for joint '"
                       << joint_handle.getName() << "'. Set the parameters p, i, d and i_clamp in "
                       << gains_nh.getNamespace() << ".");
      return false;
    }
    return true;
  }
  void starting(const ros::Time& /*time*/) {
    pid_->reset();
    joint_->setCommand(0.0);
  }
  void stopping(const ros::Time& /*time*/) {}

  /// @returns the commanded effort [N] or [Nm]
  double updateCommand(const ros::Time& /*time*/, const ros::Duration& period,
                       double /*desired_position*/, double /*desired_velocity*/,
                       double error_position, double error_velocity, double max_allowed_effort) {
    const double desired = pid_->computeCommand(error_position, error_velocity, period);
    const double effort = std::max(-max_allowed_effort, std::min(desired, max_allowed_effort));
    joint_->setCommand(effort);
    return effort;
  }

 private:
  hardware_interface::JointHandle* joint_{nullptr};
  std::unique_ptr<control_toolbox::Pid> pid_;
};
