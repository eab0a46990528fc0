// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller.h>
#include <forward_command_controller/detail/pid_loop.h>
#include <hardware_interface/joint_command_interface.h>
#include <realtime_tools/realtime_buffer.h>
#include <ros/node_handle.h>
#include <std_msgs/Float64.h>

namespace effort_controllers {

/// Controls the velocity of one joint by a Pid whose command is an effort.
///
/// Parameters: `joint`, and gains in `pid` (see control_toolbox::Pid::init). Topics in the
/// controller's namespace: `command` (std_msgs/Float64, [rad/s] or [m/s]; refused with an error if
/// not finite) and `state` (control_msgs/JointControllerState, every tenth update). Starts with a
/// velocity of zero, and stops with an effort of zero.
///
/// The control loop calls starting(), update() and stopping(). Real-time safe. setCommand() and
/// getCommand() may be called by one other thread.
class JointVelocityController
    : public controller_interface::Controller<hardware_interface::EffortJointInterface>,
      public forward_command_controller::detail::WithPidLoop {
 public:
  ~JointVelocityController() override;

  /// @return false, with an error in the log, if a parameter is missing.
  bool init(hardware_interface::EffortJointInterface* robot, ros::NodeHandle& n) override;

  /// @param cmd target velocity, [rad/s] or [m/s].
  void setCommand(double cmd);
  /// @param[out] cmd the last target velocity; after a start, zero.
  void getCommand(double& cmd);

  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;
  void stopping(const ros::Time& time) override;

 private:
  void commandCB(const std_msgs::Float64ConstPtr& msg);

  realtime_tools::RealtimeBuffer<double> command_;
  ros::Subscriber sub_command_;
};

}  // namespace effort_controllers
