// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/simple_action_server.h>
#include <boost_bind_compat/global_placeholders.h>
#include <control_msgs/GripperCommandAction.h>
#include <franka/exception.h>
#include <franka/gripper.h>
#include <franka/gripper_state.h>
#include <franka_gripper/GraspAction.h>
#include <franka_gripper/GraspEpsilon.h>
#include <franka_gripper/HomingAction.h>
#include <franka_gripper/MoveAction.h>
#include <franka_gripper/StopAction.h>

/// @file
/// The hand's actions in C++, for programs with their own franka::Gripper. franka_gripper_node does
/// not use them. All functions wait for the hand: do not call them in a control loop.

namespace franka_gripper {

/// Reads the hand's state. @returns false, after logging the reason, if it cannot be read
bool updateGripperState(const franka::Gripper& gripper, franka::GripperState* state);

/// Executes a control_msgs/GripperCommand and sets the server's result: the goal's position is that
/// of one finger [m], the result's the whole width [m]. Moves at default_speed [m/s] without effort
/// or to open, grasps with max_effort [N] otherwise.
void gripperCommandExecuteCallback(
    const franka::Gripper& gripper, const GraspEpsilon& grasp_epsilon, double default_speed,
    actionlib::SimpleActionServer<control_msgs::GripperCommandAction>* action_server,
    const control_msgs::GripperCommandGoalConstPtr& goal);

/// @name The goals of the other four actions
/// @returns whether the hand succeeded @throws franka::Exception if it refuses or is lost
/// @{
bool move(const franka::Gripper& gripper, const MoveGoalConstPtr& goal);
bool homing(const franka::Gripper& gripper, const HomingGoalConstPtr& goal);
bool stop(const franka::Gripper& gripper, const StopGoalConstPtr& goal);
bool grasp(const franka::Gripper& gripper, const GraspGoalConstPtr& goal);
/// @}

}  // namespace franka_gripper
