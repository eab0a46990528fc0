// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <control_toolbox/pid.h>
#include <controller_interface/controller.h>
#include <forward_command_controller/detail/joint_target.h>
#include <hardware_interface/joint_command_interface.h>
#include <realtime_tools/realtime_buffer.h>
#include <ros/node_handle.h>
#include <std_msgs/Float64MultiArray.h>
#include <urdf/model.h>

#include <string>
#include <vector>

namespace effort_controllers {

/// Holds several joints at positions, each by a Pid whose command is an effort.
///
/// Parameters: `joints` (names), gains in `<joint>/pid` (see control_toolbox::Pid::init), and the
/// robot's description, whose limits apply to the targets. Topic `command`
/// (std_msgs/Float64MultiArray) in the controller's namespace: one target per joint in [rad] or
/// [m]; a message of another size, or with a target that is not finite, is refused as a whole with
/// an error. Starts at the measured positions, and stops with efforts of zero.
///
/// The control loop calls starting(), update() and stopping(). Real-time safe. The subscriber's
/// callback runs elsewhere.
class JointGroupPositionController
    : public controller_interface::Controller<hardware_interface::EffortJointInterface> {
 public:
  ~JointGroupPositionController() override;

  /// @return false, with an error in the log, if a parameter or a joint of the description is
  /// missing.
  bool init(hardware_interface::EffortJointInterface* hw, ros::NodeHandle& n) override;

  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;
  void stopping(const ros::Time& time) override;

  std::vector<std::string> joint_names_;                 ///< in the order of commands
  std::vector<hardware_interface::JointHandle> joints_;  ///< in the order of commands
  realtime_tools::RealtimeBuffer<std::vector<double>> commands_buffer_;  ///< newest targets
  unsigned int n_joints_{0};                                             ///< count of joints

 private:
  bool addJoint(const std::string& name, hardware_interface::EffortJointInterface* hw,
                const ros::NodeHandle& n);
  void commandCB(const std_msgs::Float64MultiArrayConstPtr& msg);

  std::vector<control_toolbox::Pid> pid_controllers_;
  std::vector<urdf::JointConstSharedPtr> joint_urdfs_;
  std::vector<forward_command_controller::detail::JointRange> ranges_;
  ros::Subscriber sub_command_;
};

}  // namespace effort_controllers
