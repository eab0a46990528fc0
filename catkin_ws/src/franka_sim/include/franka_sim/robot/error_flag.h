// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace franka_sim {

/// The errors that the control unit itself detects: indices into the robot's error flags,
/// franka_core::kErrorNames (protocol 4.3). Those of commanded motions are MotionFlag.
enum class ErrorFlag : std::uint8_t {
  kJointPositionLimits = 0,
  kVirtualWall = 1,
  kSelfCollision = 2,
  kJointVelocity = 3,
  kCartesianVelocity = 4,
  kForceControlSafety = 5,
  kJointReflex = 6,
  kCartesianReflex = 7,
  kGoalDeviation = 8,
  kPathDeviation = 9,
  kVelocityProfile = 10,
  kForceTolerance = 23,
  kCommunication = 25,
  kPower = 26,
  kTorqueDiscontinuity = 32,
  kTorqueRange = 34,
};

constexpr std::size_t indexOf(ErrorFlag flag) noexcept { return static_cast<std::size_t>(flag); }

}  // namespace franka_sim
