// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>
#include <franka/duration.h>
#include <franka/robot_state.h>

#include <functional>

#include "franka/robot_impl.h"

namespace franka {

/// A callback that returns one kind of command.
template <typename Value>
using Callback = std::function<Value(const RobotState&, Duration)>;

/// The user's settings for one motion.
struct LoopSettings {
  bool limit_rate;
  double cutoff_frequency;  ///< [Hz]
};

/// @name Loops
/// Each runs a motion until a callback ends it. A running operation is reported before errors of
/// the arguments. @throws as Robot::control.
/// @{

/// A motion with torques alone.
void runTorqueLoop(Robot::Impl& robot, const Callback<Torques>& control_callback,
                   const LoopSettings& settings);

/// A motion generator followed by one of the robot's controllers.
template <typename Value>
void runMotionLoop(Robot::Impl& robot, const Callback<Value>& motion_callback,
                   ControllerMode controller, const LoopSettings& settings);

/// A motion generator followed by the caller's torques.
template <typename Value>
void runMotionLoop(Robot::Impl& robot, const Callback<Torques>& control_callback,
                   const Callback<Value>& motion_callback, const LoopSettings& settings);
/// @}

/// The motion generator for a kind of command.
template <typename Value>
constexpr franka_core::MotionGeneratorMode kGeneratorOf = franka_core::MotionGeneratorMode::kNone;
template <>
constexpr auto kGeneratorOf<JointPositions> = franka_core::MotionGeneratorMode::kJointPosition;
template <>
constexpr auto kGeneratorOf<JointVelocities> = franka_core::MotionGeneratorMode::kJointVelocity;
template <>
constexpr auto kGeneratorOf<CartesianPose> = franka_core::MotionGeneratorMode::kCartesianPosition;
template <>
constexpr auto kGeneratorOf<CartesianVelocities> =
    franka_core::MotionGeneratorMode::kCartesianVelocity;

/// The motion generator of a motion with torques alone. Before version 10 none exists without a
/// motion generator: joint velocities that stay zero are used.
constexpr franka_core::MotionGeneratorMode torqueGeneratorOf(std::uint16_t version) noexcept {
  return version >= 10 ? franka_core::MotionGeneratorMode::kNone
                       : franka_core::MotionGeneratorMode::kJointVelocity;
}

}  // namespace franka
