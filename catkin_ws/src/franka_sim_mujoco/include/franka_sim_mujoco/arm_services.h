// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/goal_server.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <franka_msgs/SetJointConfiguration.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <franka_sim_mujoco/sim_arm.h>
#include <ros/node_handle.h>

#include <functional>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// Of a teleport of a joint of the robot, between ticks.
struct PlaceJoint {
  using Function = std::function<void(const std::string& joint, double position)>;
  Function check;  ///< @throws std::runtime_error for an impossible position
  Function place;  ///< of one that was checked
};

/// The services and the recovery action of a simulated arm: those of the robot's own node and
/// set_user_stop under `franka_control` in its service namespace, set_franka_model_configuration in
/// that namespace itself. They run in service and action threads and access the arm between ticks.
/// Invalid requests return success = false and a message, and change nothing.
class ArmServices {
 public:
  /// @param node of the robot's namespace @param described names the arm
  /// @param restart_controllers restarts the controllers that command the arm, after a recovery and
  /// after a teleport of the joints; without it, they are stopped after a recovery
  ArmServices(const ros::NodeHandle& node, const SimulatedArm& described, SimArm& arm,
              BetweenTicks between_ticks, PlaceJoint place_joint, bool restart_controllers);
  ~ArmServices();
  ArmServices(const ArmServices&) = delete;
  ArmServices& operator=(const ArmServices&) = delete;

 private:
  template <typename Service>
  void offer(ros::NodeHandle& node, const std::string& name,
             std::function<void(const typename Service::Request&)> handler);
  template <typename Service>
  void offerBetweenTicks(const std::string& name,
                         std::function<void(const typename Service::Request&)> handler);
  void offerSetters();
  void offerUserStop();
  void offerConnection(const std::string& name, bool connects);
  void offerConfiguration();
  void placeJoints(const franka_msgs::SetJointConfiguration::Request& request);
  void recover();
  void recoverUnit();
  bool recovering();
  bool moves();
  /// Stops the controllers that command the arm, and starts them again if `restart`.
  /// @throws std::runtime_error if that failed
  void switchArmControllers(bool restart);
  bool switches(const std::vector<std::string>& start, const std::vector<std::string>& stop);
  std::vector<std::string> runningArmControllers();

  ros::NodeHandle robot_node_, arm_node_, control_node_;
  std::string arm_id_;
  SimArm& arm_;
  BetweenTicks between_ticks_;
  PlaceJoint place_joint_;
  bool restart_controllers_;
  std::vector<ros::ServiceServer> servers_;
  franka_hw::GoalServer<franka_msgs::ErrorRecoveryAction> recovery_;
};

}  // namespace franka_sim_mujoco
