// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/simple_action_server.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <franka_sim_mujoco/ros/sim_arm.h>
#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// The services and the recovery action of a simulated arm, under `franka_control` in its
/// namespace. They run in service and action threads and reach the arm between ticks.
class ArmServices {
 public:
  /// @param restart_controllers whether a recovery restarts the controllers that command the arm
  ArmServices(const ros::NodeHandle& node, const std::string& arm_id, SimArm& arm,
              BetweenTicks between_ticks, bool restart_controllers);
  ~ArmServices();
  ArmServices(const ArmServices&) = delete;
  ArmServices& operator=(const ArmServices&) = delete;

 private:
  template <typename Service>
  void offer(const std::string& name,
             std::function<void(const typename Service::Request&)> handler);
  void offerUserStop();
  void recover();
  void recoverUnit();
  void restartArmControllers();
  std::vector<std::string> runningArmControllers();
  /// @throws std::runtime_error with a sentence unless the unit accepted
  void check(RequestStatus status, const std::string& why_invalid);

  ros::NodeHandle node_;
  ros::NodeHandle control_node_;
  std::string arm_id_;
  SimArm& arm_;
  BetweenTicks between_ticks_;
  bool restart_controllers_;
  std::vector<ros::ServiceServer> servers_;
  actionlib::SimpleActionServer<franka_msgs::ErrorRecoveryAction> recovery_;
};

}  // namespace franka_sim_mujoco
