// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller.h>
#include <realtime_tools/realtime_buffer.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <std_msgs/Float64.h>
#include <urdf/model.h>

#include <cmath>

#include "forward_command_controller/detail/joint_target.h"
#include "forward_command_controller/detail/pid_loop.h"
#include "forward_command_controller/detail/rest.h"

namespace forward_command_controller {
namespace detail {

/// Holds one joint at a position by a Pid whose command is an effort or a velocity.
///
/// Parameters: `joint`, gains in `pid` (see control_toolbox::Pid::init), and the robot's
/// description, whose limits apply to the target. Topics in the controller's namespace: `command`
/// (std_msgs/Float64, the target in [rad] or [m]; refused with an error if not finite) and `state`
/// (control_msgs/JointControllerState, every tenth update). Starts at the measured position, and
/// stops with a command of zero.
///
/// The control loop calls starting(), update() and stopping(). Real-time safe. Any other thread may
/// call setCommand().
///
/// @tparam T hardware_interface::EffortJointInterface or VelocityJointInterface.
template <class T>
class JointPositionController : public controller_interface::Controller<T>, public WithPidLoop {
 public:
  /// A target. Without `has_velocity_` the error's derivative is computed from step to step.
  struct Commands {
    double position_{0.0};
    double velocity_{0.0};
    bool has_velocity_{false};
  };

  ~JointPositionController() override { sub_command_.shutdown(); }

  bool init(T* robot, ros::NodeHandle& n) override {
    if (!initJoint(robot, n) || !findJoint(n, joint_.getName(), joint_urdf_)) {
      return false;
    }
    range_ = JointRange(*joint_urdf_);
    sub_command_ =
        n.subscribe<std_msgs::Float64>("command", 1, &JointPositionController::commandCB, this);
    return true;
  }

  /// @param pos_target in [rad] or [m].
  void setCommand(double pos_target) { accept(pos_target, 0.0, false); }
  /// @param vel_target of the moving target, in [rad/s] or [m/s].
  void setCommand(double pos_target, double vel_target) { accept(pos_target, vel_target, true); }

  void starting(const ros::Time& /*time*/) override {
    Commands here;
    here.position_ = range_.clamped(joint_.getPosition());
    command_.initRT(here);
    loop_.start();
  }

  void update(const ros::Time& time, const ros::Duration& period) override {
    const Commands& command = *command_.readFromRT();
    const double position = joint_.getPosition();
    const double target = range_.clamped(command.position_);
    const double error = range_.way(position, target);
    if (command.has_velocity_) {
      joint_.setCommand(loop_.command(error, command.velocity_ - joint_.getVelocity(), period));
    } else {
      joint_.setCommand(loop_.command(error, period));
    }
    loop_.publish(time, period, target, position, error, joint_);
  }

  void stopping(const ros::Time& /*time*/) override { rest<T>(joint_); }

  /// The measured position, in [rad] or [m].
  double getPosition() { return joint_.getPosition(); }

  urdf::JointConstSharedPtr joint_urdf_;
  realtime_tools::RealtimeBuffer<Commands> command_;

 private:
  void commandCB(const std_msgs::Float64ConstPtr& msg) { setCommand(msg->data); }

  void accept(double position, double velocity, bool has_velocity) {
    if (!std::isfinite(position) || !std::isfinite(velocity)) {
      ROS_ERROR_STREAM_THROTTLE(1.0, "The command for joint '"
                                         << joint_.getName() << "' (position " << position
                                         << ", velocity " << velocity
                                         << ") is not finite. Not executing; the last command "
                                            "stays.");
      return;
    }
    Commands command;
    command.position_ = position;
    command.velocity_ = velocity;
    command.has_velocity_ = has_velocity;
    command_.writeFromNonRT(command);
  }

  JointRange range_;
  ros::Subscriber sub_command_;
};

}  // namespace detail
}  // namespace forward_command_controller
