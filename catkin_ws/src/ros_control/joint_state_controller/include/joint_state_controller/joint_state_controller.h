// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller.h>
#include <hardware_interface/joint_state_interface.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include <memory>
#include <string>
#include <vector>

namespace joint_state_controller {

/// Publishes positions, velocities and efforts of joints (sensor_msgs/JointState) on the topic
/// `joint_states` of the controller manager's namespace; units are those of the handles.
///
/// Parameters, in the controller's namespace:
///   `publish_rate` [Hz], required; nothing is published unless it is positive.
///   `joints`: names, in the order of publishing; default: all of the robot, sorted by name.
///   `extra_joints`: list of {name, position, velocity, effort}, numbers default to 0, of joints
///   without a handle; published with every message. An invalid entry is skipped with an error.
///
/// The first update publishes; later ones keep the rate if the loop can follow it, and restart it
/// after a delay or a jump back in time.
///
/// The control loop calls starting(), update() and stopping(). Real-time safe.
class JointStateController
    : public controller_interface::Controller<hardware_interface::JointStateInterface> {
 public:
  /// @return false, with an error in the log, without `publish_rate`.
  /// @throw hardware_interface::HardwareInterfaceException for an unknown joint.
  bool init(hardware_interface::JointStateInterface* hw, ros::NodeHandle& root_nh,
            ros::NodeHandle& controller_nh) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;
  void stopping(const ros::Time& time) override;

 private:
  bool isDue(const ros::Time& time);

  typedef realtime_tools::RealtimePublisher<sensor_msgs::JointState> Publisher;

  std::vector<hardware_interface::JointStateHandle> joint_state_;
  std::unique_ptr<Publisher> realtime_pub_;
  double period_{0.0};  ///< [s]; 0: nothing is published
  double next_{0.0};    ///< time of the next message [s]
};

}  // namespace joint_state_controller
