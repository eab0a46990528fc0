// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller.h>
#include <hardware_interface/joint_command_interface.h>
#include <realtime_tools/realtime_buffer.h>
#include <ros/node_handle.h>
#include <std_msgs/Float64MultiArray.h>

#include <cstddef>
#include <string>
#include <vector>

#include "forward_command_controller/detail/joint_group.h"
#include "forward_command_controller/detail/rest.h"

namespace forward_command_controller {

/// Forwards the newest numbers from a topic to several joints.
///
/// Parameter `joints`: their names. Topic `command` (std_msgs/Float64MultiArray) in the
/// controller's namespace: one command per joint, in that order, in the unit of the interface. A
/// message of another size, or with a command that is not finite, is refused as a whole with an
/// error, and the last valid one stays.
///
/// starting() is specialized for each kind of joint. When the controller stops, velocities and
/// efforts are set to zero.
///
/// The control loop calls starting(), update() and stopping(). Real-time safe. The subscriber's
/// callback runs elsewhere.
///
/// @tparam T a joint interface with one command.
template <class T>
class ForwardJointGroupCommandController : public controller_interface::Controller<T> {
 public:
  ForwardJointGroupCommandController() = default;
  ~ForwardJointGroupCommandController() override { sub_command_.shutdown(); }

  /// Gets the joints and subscribes.
  /// @return false, with an error in the log, without a list of unique names.
  /// @throw hardware_interface::HardwareInterfaceException for an unknown joint.
  bool init(T* hw, ros::NodeHandle& n) override {
    if (!detail::readJointNames(n, joint_names_)) {
      return false;
    }
    n_joints_ = static_cast<unsigned int>(joint_names_.size());
    for (const std::string& name : joint_names_) {
      joints_.push_back(hw->getHandle(name));
    }
    detail::prepareBuffer(joint_names_.size(), commands_buffer_);
    sub_command_ = n.subscribe<std_msgs::Float64MultiArray>(
        "command", 1, &ForwardJointGroupCommandController::commandCB, this);
    return true;
  }

  void starting(const ros::Time& time) override;

  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    const std::vector<double>& commands = *commands_buffer_.readFromRT();
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      joints_[i].setCommand(commands[i]);
    }
  }

  void stopping(const ros::Time& /*time*/) override {
    for (hardware_interface::JointHandle& joint : joints_) {
      detail::rest<T>(joint);
    }
  }

  std::vector<std::string> joint_names_;
  std::vector<hardware_interface::JointHandle> joints_;
  realtime_tools::RealtimeBuffer<std::vector<double>> commands_buffer_;
  unsigned int n_joints_{0};  ///< count of joints

 private:
  void commandCB(const std_msgs::Float64MultiArrayConstPtr& msg) {
    detail::acceptCommands(msg->data, joint_names_, commands_buffer_);
  }

  ros::Subscriber sub_command_;
};

}  // namespace forward_command_controller
