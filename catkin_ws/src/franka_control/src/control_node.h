// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/simple_action_server.h>
#include <controller_manager/controller_manager.h>
#include <franka_hw/abort_reporter.h>
#include <franka_hw/franka_hw.h>
#include <franka_hw/reconnection.h>
#include <franka_hw/services.h>
#include <franka_hw/thrown_report.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "loop_health.h"
#include "robot_health.h"

namespace franka_control {

/// The node franka_control_node: one arm, one controller manager, and what keeps them running
/// together through errors. Only a signal ends it.
///
/// Parameters beside those of FrankaHW, of franka_hw::Reconnection and franka_hw::AbortReporter, in
/// the node's own namespace: `restart_controllers_after_recovery` (bool, true): whether controllers
/// that were running when the robot stopped start again after a recovery, through their starting(),
/// or are stopped first. Topic `has_error` (std_msgs/Bool, latched): whether the robot stopped and
/// waits for a recovery.
class ControlNode {
 public:
  ControlNode(const ros::NodeHandle& public_nh, const ros::NodeHandle& private_nh);

  /// @returns false after a sentence when the robot cannot be set up
  bool init();
  /// The loop; returns when ROS ends.
  void run();

 private:
  using RecoveryServer = actionlib::SimpleActionServer<franka_msgs::ErrorRecoveryAction>;
  typedef std_srvs::Trigger::Request TriggerRequest;
  typedef std_srvs::Trigger::Response TriggerResponse;

  void offerConnection();
  void offerRobot();
  void withdrawRobot();
  bool connectRequested(TriggerRequest& request, TriggerResponse& response);
  bool disconnectRequested(TriggerRequest& request, TriggerResponse& response);
  /// Whether there is an error, or the robot was stopped while no controller moved it.
  bool needsRecovery() const;
  void recover();

  void connectRobot();
  void watchIdleRobot();
  void readIdleRobot();
  void controllerThrew(const std::string& what);
  void recoveredByOthers();
  void moveRobot();
  bool updateMoving(const ros::Time& time, const ros::Duration& period);
  void updateControllers(const ros::Time& time, const ros::Duration& period, bool reset);
  void motionFailed(const std::string& what, const std::vector<franka::Record>& log);
  /// Outside motions only: it publishes.
  void setError(bool has_error);
  void robotLost(const std::string& what);

  ros::NodeHandle public_nh_, private_nh_;
  franka_hw::FrankaHW franka_hw_;
  const franka::RobotState* robot_state_{nullptr};  // what the controllers see
  std::unique_ptr<controller_manager::ControllerManager> controller_manager_;
  std::unique_ptr<franka_hw::AbortReporter> aborts_;
  std::unique_ptr<RobotHealth> robot_health_;
  std::unique_ptr<LoopHealth> loop_health_;

  std::mutex connection_mutex_;  // one at a time connects, disconnects or recovers
  std::unique_ptr<franka_hw::ServiceContainer> robot_services_;
  std::unique_ptr<RecoveryServer> recovery_server_;
  ros::ServiceServer connect_server_, disconnect_server_;
  ros::Publisher has_error_publisher_;
  ros::WallTimer stop_timer_;
  std::atomic_bool stopping_controllers_{false};

  std::atomic_bool connected_{false};
  std::atomic_bool lost_{false};  // the connection, without being asked to
  std::atomic_bool has_error_{false};
  std::atomic_bool robot_stopped_{false};  // the error is the robot's, and ends when it is Idle
  bool interrupted_{false};                // the last motion, by an error; of the loop
  bool restarts_controllers_{true};
  franka_hw::ThrownReport thrown_report_;  // of the loop
  franka_hw::Reconnection reconnection_;   // of the loop
  std::string arm_id_;
  ros::Time last_update_;
};

}  // namespace franka_control
