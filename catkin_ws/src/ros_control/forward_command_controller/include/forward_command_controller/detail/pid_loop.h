// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <control_msgs/JointControllerState.h>
#include <control_toolbox/pid.h>
#include <hardware_interface/joint_command_interface.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include <memory>
#include <string>

namespace forward_command_controller {
namespace detail {

/// A Pid with gains from the namespace `pid`, and the topic `state` (JointControllerState),
/// published every tenth step. Any thread may read and set the gains. The control loop calls
/// start(), command() and publish(). Real-time safe.
class PidLoop {
 public:
  /// @param node the controller's namespace.
  /// @return false, with an error in the log, without gains.
  bool init(const ros::NodeHandle& node) {
    if (!pid_.init(ros::NodeHandle(node, "pid"))) {
      return false;
    }
    publisher_ = std::make_unique<Publisher>(node, "state", 1);
    return true;
  }

  /// Resets earlier errors.
  void start() {
    pid_.reset();
    steps_ = 0;
  }

  /// One step. @return the command for `error`, with a given derivative of the error or one
  /// computed from the step before.
  double command(double error, const ros::Duration& period) {
    return pid_.computeCommand(error, period);
  }
  double command(double error, double error_dot, const ros::Duration& period) {
    return pid_.computeCommand(error, error_dot, period);
  }

  /// Publishes in every tenth step. @param process_value measured value for `set_point`.
  void publish(const ros::Time& time, const ros::Duration& period, double set_point,
               double process_value, double error, const hardware_interface::JointHandle& joint) {
    if (steps_++ % kStepsPerState != 0 || !publisher_->trylock()) {
      return;
    }
    control_msgs::JointControllerState& state = publisher_->msg_;
    state.header.stamp = time;
    state.set_point = set_point;
    state.process_value = process_value;
    state.process_value_dot = joint.getVelocity();
    state.error = error;
    state.time_step = period.toSec();
    state.command = joint.getCommand();
    const control_toolbox::Pid::Gains gains = pid_.getGains();
    state.p = gains.p_gain_;
    state.i = gains.i_gain_;
    state.d = gains.d_gain_;
    state.i_clamp = gains.i_max_;
    state.antiwindup = static_cast<decltype(state.antiwindup)>(gains.antiwindup_);
    publisher_->unlockAndPublish();
  }

  control_toolbox::Pid& pid() { return pid_; }

 private:
  typedef realtime_tools::RealtimePublisher<control_msgs::JointControllerState> Publisher;
  static constexpr unsigned kStepsPerState = 10;  // as in the original

  control_toolbox::Pid pid_;
  std::unique_ptr<Publisher> publisher_;
  unsigned steps_{0};
};

/// Functions of controllers with one PidLoop.
class WithPidLoop {
 public:
  void getGains(double& p, double& i, double& d, double& i_max, double& i_min) {
    loop_.pid().getGains(p, i, d, i_max, i_min);
  }
  void getGains(double& p, double& i, double& d, double& i_max, double& i_min, bool& antiwindup) {
    loop_.pid().getGains(p, i, d, i_max, i_min, antiwindup);
  }
  /// Also updates dynamic reconfigure. Thread-safe. Not real-time safe.
  void setGains(const double& p, const double& i, const double& d, const double& i_max,
                const double& i_min, const bool& antiwindup = false) {
    loop_.pid().setGains(p, i, d, i_max, i_min, antiwindup);
  }
  /// Writes gains, errors and command to the log.
  void printDebug() { loop_.pid().printValues(); }
  std::string getJointName() { return joint_.getName(); }

  hardware_interface::JointHandle joint_;

 protected:
  WithPidLoop() = default;
  ~WithPidLoop() = default;

  /// Gets the joint of the parameter `joint`, with gains from the namespace `pid`.
  /// @return false, with an error in the log, if a parameter is missing.
  /// @throw hardware_interface::HardwareInterfaceException for an unknown joint.
  template <class T>
  bool initJoint(T* robot, const ros::NodeHandle& n) {
    std::string joint_name;
    if (!n.getParam("joint", joint_name)) {
      ROS_ERROR("No joint given (namespace: %s)", n.getNamespace().c_str());
      return false;
    }
    joint_ = robot->getHandle(joint_name);
    return loop_.init(n);
  }

  PidLoop loop_;
};

}  // namespace detail
}  // namespace forward_command_controller
