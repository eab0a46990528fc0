// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller.h>
#include <hardware_interface/joint_command_interface.h>
#include <realtime_tools/realtime_buffer.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <std_msgs/Float64.h>

#include <cmath>
#include <string>

#include "forward_command_controller/detail/rest.h"

namespace forward_command_controller {

/// Forwards the newest number from a topic to one joint.
///
/// Parameter `joint`: the joint's name. Topic `command` (std_msgs/Float64) in the controller's
/// namespace: the command in the unit of the interface ([rad], [rad/s], [Nm]; m and N for prismatic
/// joints). A command that is not finite is refused with an error, and the last valid one stays.
///
/// starting() is specialized for each kind of joint. When the controller stops, a velocity or an
/// effort is set to zero.
///
/// The control loop calls starting(), update() and stopping(). Real-time safe. The subscriber's
/// callback runs elsewhere.
///
/// @tparam T a joint interface with one command, for instance
/// hardware_interface::EffortJointInterface.
template <class T>
class ForwardCommandController : public controller_interface::Controller<T> {
 public:
  ForwardCommandController() = default;
  ~ForwardCommandController() override { sub_command_.shutdown(); }

  /// Gets the joint and subscribes.
  /// @return false, with an error in the log, without the parameter `joint`.
  /// @throw hardware_interface::HardwareInterfaceException for an unknown joint.
  bool init(T* hw, ros::NodeHandle& n) override {
    std::string joint_name;
    if (!n.getParam("joint", joint_name)) {
      ROS_ERROR("No joint given (namespace: %s)", n.getNamespace().c_str());
      return false;
    }
    joint_ = hw->getHandle(joint_name);
    sub_command_ =
        n.subscribe<std_msgs::Float64>("command", 1, &ForwardCommandController::commandCB, this);
    return true;
  }

  void starting(const ros::Time& time) override;

  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    joint_.setCommand(*command_buffer_.readFromRT());
  }

  void stopping(const ros::Time& /*time*/) override { detail::rest<T>(joint_); }

  hardware_interface::JointHandle joint_;  ///< of the parameter joint
  realtime_tools::RealtimeBuffer<double> command_buffer_;

 private:
  void commandCB(const std_msgs::Float64ConstPtr& msg) {
    if (!std::isfinite(msg->data)) {
      ROS_ERROR_STREAM_THROTTLE(
          1.0, "The command for joint '"
                   << joint_.getName() << "' is " << msg->data
                   << ", which is not a finite number. Not executing; the last command stays.");
      return;
    }
    command_buffer_.writeFromNonRT(msg->data);
  }

  ros::Subscriber sub_command_;
};

}  // namespace forward_command_controller
