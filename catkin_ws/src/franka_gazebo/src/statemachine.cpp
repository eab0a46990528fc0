// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_gazebo/statemachine.h>
#include <ros/console.h>

#include <algorithm>

namespace franka_gazebo {

bool contains(const std::string& haystack, const std::string& needle) {
  return haystack.find(needle) != std::string::npos;
}

bool isPressed(const UserStop& event) { return event.pressed; }

bool isReleased(const UserStop& event) { return !event.pressed; }

bool isStarting(const SwitchControl& /*event*/, const JointMap& joints) {
  return std::any_of(joints.begin(), joints.end(), [](const auto& joint) {
    return !contains(joint.first, "_finger_joint") && joint.second->control_method;
  });
}

bool isStopping(const SwitchControl& event, const JointMap& joints) {
  return !isStarting(event, joints);
}

void start(franka::RobotState& state) { state.robot_mode = franka::RobotMode::kMove; }

void idle(franka::RobotState& state) { state.robot_mode = franka::RobotMode::kIdle; }

void stop(franka::RobotState& state, JointMap& joints) {
  ROS_WARN_NAMED("franka_hw_sim", "The user stop is pressed: the arm stays where it is.");
  state.robot_mode = franka::RobotMode::kUserStopped;
  state.q_d = state.q;
  state.dq_d.fill(0.0);
  state.ddq_d.fill(0.0);
  for (auto& [name, joint] : joints) {
    if (!contains(name, "_finger_joint")) {
      joint->stop_position = joint->desired_position = joint->position;
      joint->desired_velocity = 0.0;
    }
  }
}

bool StateMachine::process_event(const ErrorRecovery& /*event*/) {
  if (now_ != Now::kIdle) {
    return false;
  }
  start(state_);
  now_ = Now::kMove;
  return true;
}

bool StateMachine::process_event(const SwitchControl& event) {
  if (now_ == Now::kIdle && isStarting(event, joints_)) {
    start(state_);
    now_ = Now::kMove;
    return true;
  }
  if (now_ == Now::kMove && isStopping(event, joints_)) {
    idle(state_);
    now_ = Now::kIdle;
    return true;
  }
  return false;
}

bool StateMachine::process_event(const UserStop& event) {
  if (now_ != Now::kUserStopped && isPressed(event)) {
    stop(state_, joints_);
    now_ = Now::kUserStopped;
    return true;
  }
  if (now_ == Now::kUserStopped && isReleased(event)) {
    idle(state_);
    now_ = Now::kIdle;
    return true;
  }
  return false;
}

}  // namespace franka_gazebo
