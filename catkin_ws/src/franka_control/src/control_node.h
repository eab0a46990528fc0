// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/controller_manager.h>
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

/// The node franka_control_node: one arm, one controller manager, and what keeps them running
/// together through errors. Only a signal ends it.
///
/// What the arm offers and how it recovers and reconnects: franka_hw::ArmConnection. A parameter
/// beside those of FrankaHW, in the node's own namespace: `restart_controllers_after_recovery`
/// (bool, true): whether controllers that were running when the robot stopped start again after a
/// recovery, through their starting(), or are stopped first.
///
/// One thread calls init() and run(), which is the robot's.
class ControlNode {
 public:
  ControlNode(const ros::NodeHandle& public_nh, const ros::NodeHandle& private_nh);

  /// @returns false after a sentence when the robot cannot be set up
  bool init();
  /// The loop; returns when ROS ends.
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
  const franka::RobotState* robot_state_{nullptr};  // what the controllers see
  std::unique_ptr<controller_manager::ControllerManager> controller_manager_;
  std::unique_ptr<RobotHealth> robot_health_;
  std::unique_ptr<LoopHealth> loop_health_;

  ros::WallTimer stop_timer_;
  std::atomic_bool stopping_controllers_{false};

  bool interrupted_{false};  // the last motion, by an error
  bool restarts_controllers_{true};
  franka_hw::ThrownReport thrown_report_;
  ros::Time last_update_;
};

}  // namespace franka_control
