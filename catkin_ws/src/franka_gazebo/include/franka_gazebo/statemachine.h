// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_gazebo/joint.h>

#include <map>
#include <memory>
#include <string>

namespace franka_gazebo {

/// Joints by their names.
using JointMap = std::map<std::string, std::shared_ptr<Joint>>;

/// Whether a text contains another.
bool contains(const std::string& haystack, const std::string& needle);

/// @name States
/// @{
struct Idle {};         ///< no controller moves the arm
struct Move {};         ///< a controller moves it
struct UserStopped {};  ///< the user stop is pressed
/// @}

/// @name Events
/// @{
struct ErrorRecovery {};  ///< the action was called
struct SwitchControl {};  ///< controllers were switched
/// The user stop was pressed or released.
struct UserStop {
  bool pressed;  ///< otherwise released
};
/// @}

/// @name Guards and actions
/// @{
bool isPressed(const UserStop& event);
bool isReleased(const UserStop& event);
bool isStarting(const SwitchControl& event, const JointMap& joints);  ///< a joint of the arm moves
bool isStopping(const SwitchControl& event, const JointMap& joints);
void start(franka::RobotState& state);
void idle(franka::RobotState& state);
void stop(franka::RobotState& state, JointMap& joints);  ///< holds the arm at its position
/// @}

/// Idle, Move and UserStopped with the original's transitions; every other event is ignored. The
/// original is a table for boost::sml, which Debian lacks; this class has the functions of sml::sm
/// itself. The simulation uses another mode machine.
class StateMachine {
 public:
  /// Both must outlive it.
  StateMachine(franka::RobotState& state, JointMap& joints) : state_(state), joints_(joints) {}

  /// @returns whether the event had an effect
  bool process_event(const ErrorRecovery& event);
  bool process_event(const SwitchControl& event);
  bool process_event(const UserStop& event);

  bool is(Idle /*state*/) const noexcept { return now_ == Now::kIdle; }
  bool is(Move /*state*/) const noexcept { return now_ == Now::kMove; }
  /// Whether this is its state.
  bool is(UserStopped /*state*/) const noexcept { return now_ == Now::kUserStopped; }

 private:
  enum class Now { kIdle, kMove, kUserStopped };

  franka::RobotState& state_;
  JointMap& joints_;
  Now now_{Now::kIdle};
};

}  // namespace franka_gazebo
