// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/controller_manager.h>
#include <franka_hw/arm_connection.h>
#include <franka_hw/franka_hw.h>
#include <franka_hw/thrown_report.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <atomic>
#include <exception>
#include <memory>
#include <string>

#include "loop_health.h"
#include "robot_health.h"

namespace franka_control {

/// The node franka_control_node: one arm and one controller manager, which continue after errors.
/// Only a signal ends the node.
///
/// Services of the arm, its recovery and its reconnection: franka_hw::ArmConnection. Besides those
/// of FrankaHW, there is one parameter in the node's own namespace:
/// `restart_controllers_after_recovery` (bool, true): whether controllers that were running when
/// the robot stopped are started again after a recovery, through their starting(), or are stopped
/// first.
///
/// The robot's thread calls init() and run().
class ControlNode {
 public:
  ControlNode(const ros::NodeHandle& public_nh, const ros::NodeHandle& private_nh);

  /// @returns false, after logging the reason, if the robot cannot be set up
  bool init();
  /// The control loop; returns when ROS shuts down.
  void run();

 private:
  void watchIdleRobot();
  void controllerThrew(const std::string& what);
  void recoveredByOthers();
  void moveRobot();
  bool updateMoving(const ros::Time& time, const ros::Duration& period);
  void updateControllers(const ros::Time& time, const ros::Duration& period, bool reset);

  ros::NodeHandle public_nh_, private_nh_;
  franka_hw::FrankaHW franka_hw_;
  franka_hw::ArmConnection& connection_{franka_hw_.armConnection()};
  const franka::RobotState* robot_state_{nullptr};  // the state that the controllers read
  std::unique_ptr<controller_manager::ControllerManager> controller_manager_;
  std::unique_ptr<RobotHealth> robot_health_;
  std::unique_ptr<LoopHealth> loop_health_;

  ros::WallTimer stop_timer_;
  std::atomic_bool stopping_controllers_{false};

  bool interrupted_{false};  // an error ended the last motion
  bool restarts_controllers_{true};
  franka_hw::ThrownReport thrown_report_;
  ros::Time last_update_;
};

}  // namespace franka_control
