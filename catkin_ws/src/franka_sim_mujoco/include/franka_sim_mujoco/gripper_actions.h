// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <control_msgs/GripperCommandAction.h>
#include <franka_gripper/GraspAction.h>
#include <franka_gripper/HomingAction.h>
#include <franka_gripper/MoveAction.h>
#include <franka_gripper/StopAction.h>
#include <franka_hw/goal_server.h>
#include <franka_sim_mujoco/gripper_mailbox.h>
#include <ros/node_handle.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>

namespace franka_sim_mujoco {

/// State of the gripper that the loop shares with other threads.
struct GripperView {
  std::atomic<bool> controller_runs{false};
  std::atomic<double> width{0.0};  ///< [m]
};

struct GripperActionParameters {
  double max_width{0.08};                        ///< [m]
  double gripper_action_width_tolerance{0.005};  ///< [m]
  double gripper_action_speed{0.1};              ///< [m/s]
};

/// The hand's five actions: stop, homing, move, grasp and gripper_action, in the controller's
/// namespace. A goal of one interrupts the command of another, unless it
/// is not possible. Each runs in its own thread.
class GripperActions {
 public:
  GripperActions(const ros::NodeHandle& node, const GripperActionParameters& parameters,
                 GripperMailbox& mailbox, const GripperView& view);
  ~GripperActions();
  GripperActions(const GripperActions&) = delete;
  GripperActions& operator=(const GripperActions&) = delete;

 private:
  using Fate = GripperCommand::Fate;
  template <typename Action>
  using Server = franka_hw::GoalServer<Action>;

  void stop();
  void homing();
  void move(const franka_gripper::MoveGoal& goal);
  void grasp(const franka_gripper::GraspGoal& goal);
  void gripperCommand(const control_msgs::GripperCommandGoal& goal);

  /// Posts the command and waits; ends the goal unless the command completed. @returns whether it
  /// completed, with the fate kSucceeded or kFailed
  template <typename Action, typename Result>
  bool carryOut(Server<Action>& server, const std::shared_ptr<GripperCommand>& command,
                Result& result);
  template <typename Action>
  Fate await(Server<Action>& server, const GripperCommand& command) const;
  // Why a goal is not possible; empty if it is.
  std::string widthFault(double width) const;
  std::string fingersFault(double width, double speed) const;
  std::string moveFault(const franka_gripper::MoveGoal& goal) const;
  std::string graspFault(const franka_gripper::GraspGoal& goal) const;
  std::string commandFault(const control_msgs::GripperCommandGoal& goal) const;
  /// Copies a fault to the result. @returns the fault
  template <typename Result>
  std::string explained(const std::string& fault, Result& result) const;

  GripperActionParameters parameters_;
  GripperMailbox& mailbox_;
  const GripperView& view_;
  std::atomic<bool> ending_{false};
  Server<franka_gripper::StopAction> stop_server_;
  Server<franka_gripper::HomingAction> homing_server_;
  Server<franka_gripper::MoveAction> move_server_;
  Server<franka_gripper::GraspAction> grasp_server_;
  Server<control_msgs::GripperCommandAction> command_server_;
};

}  // namespace franka_sim_mujoco
