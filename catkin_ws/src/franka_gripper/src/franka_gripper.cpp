// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka_core/numbers.h>
#include <franka_gripper/franka_gripper.h>
#include <ros/console.h>

#include <cmath>
#include <string>

namespace franka_gripper {

namespace {

constexpr double kNoEffort = 1e-4;  // [N] smaller efforts mean: move, do not grasp
constexpr double kArrived = 1e-4;   // [m] closer targets count as reached

/// @returns whether the hand succeeded @throws franka::Exception
bool carryOut(const franka::Gripper& gripper, const GraspEpsilon& epsilon, double speed,
              double width, double effort, double present_width) {
  if (std::abs(width - present_width) < kArrived) {
    return true;
  }
  if (std::abs(effort) < kNoEffort || width >= present_width) {
    return gripper.move(width, speed);
  }
  return gripper.grasp(width, speed, std::abs(effort), epsilon.inner, epsilon.outer);
}

}  // namespace

bool updateGripperState(const franka::Gripper& gripper, franka::GripperState* state) {
  try {
    *state = gripper.readOnce();
    return true;
  } catch (const franka::Exception& error) {
    ROS_ERROR_STREAM("franka_gripper: the hand's state could not be read. " << error.what());
    return false;
  }
}

void gripperCommandExecuteCallback(
    const franka::Gripper& gripper, const GraspEpsilon& grasp_epsilon, double default_speed,
    actionlib::SimpleActionServer<control_msgs::GripperCommandAction>* action_server,
    const control_msgs::GripperCommandGoalConstPtr& goal) {
  control_msgs::GripperCommandResult result;
  const auto abort = [&](const std::string& text) {
    ROS_ERROR_STREAM("franka_gripper, gripper_action: " << text);
    action_server->setAborted(result, text);
  };
  const double width = 2.0 * goal->command.position;
  franka::GripperState state;
  if (!updateGripperState(gripper, &state)) {
    abort("The hand's state could not be read.");
    return;
  }
  result.position = state.width;
  if (!(width >= 0.0 && width <= state.max_width)) {
    abort("The width " + franka_core::numberText(width) +
          " m is not possible: it must lie between 0 and " +
          franka_core::numberText(state.max_width) + " m.");
    return;
  }
  bool reached = false;
  std::string fault;
  try {
    reached = carryOut(gripper, grasp_epsilon, default_speed, width, goal->command.max_effort,
                       state.width);
  } catch (const franka::Exception& error) {
    fault = error.what();
  }
  if (updateGripperState(gripper, &state)) {
    result.position = state.width;
  } else if (fault.empty()) {
    fault = "The hand's state could not be read.";
  }
  if (!fault.empty()) {
    abort(fault);
    return;
  }
  result.reached_goal = static_cast<unsigned char>(reached);
  // Fingers that hold an object, or that came to rest elsewhere.
  result.stalled = static_cast<unsigned char>(state.is_grasped || !reached);
  result.effort = state.is_grasped ? std::abs(goal->command.max_effort) : 0.0;
  if (!reached) {
    abort(
        "The fingers did not reach their goal: something is in their way, or there is nothing to "
        "grasp.");
    return;
  }
  action_server->setSucceeded(result);
}

bool move(const franka::Gripper& gripper, const MoveGoalConstPtr& goal) {
  return gripper.move(goal->width, goal->speed);
}

bool homing(const franka::Gripper& gripper, const HomingGoalConstPtr& /*goal*/) {
  return gripper.homing();
}

bool stop(const franka::Gripper& gripper, const StopGoalConstPtr& /*goal*/) {
  return gripper.stop();
}

bool grasp(const franka::Gripper& gripper, const GraspGoalConstPtr& goal) {
  return gripper.grasp(goal->width, goal->speed, goal->force, goal->epsilon.inner,
                       goal->epsilon.outer);
}

}  // namespace franka_gripper
