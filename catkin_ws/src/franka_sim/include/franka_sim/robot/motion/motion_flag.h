// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace franka_sim {

/// The errors that a commanded motion can raise: indices into the robot's error flags,
/// franka_core::kErrorNames (protocol 4.3).
enum class MotionFlag : std::uint8_t {
  kJointPositionLimits = 0,  ///< in place of 12 and 27 from system 5.7.2 on
  kJointStartPose = 11,
  kCommandedJointPosition = 12,
  kJointVelocity = 13,
  kJointAcceleration = 14,  ///< "velocity_discontinuity"
  kJointJerk = 15,          ///< "acceleration_discontinuity"
  kCartesianStartPose = 16,
  kElbowLimit = 17,
  kCartesianVelocity = 18,
  kCartesianAcceleration = 19,
  kCartesianJerk = 20,
  kElbowSign = 21,
  kStartElbow = 22,
  kSolvedJointPosition = 27,  ///< 27 to 30: the joint motion that follows from a Cartesian command
  kSolvedJointVelocity = 28,
  kSolvedJointAcceleration = 29,
  kSolvedJointJerk = 30,
  kInvalidFrame = 31,
};

/// Empty, or the error of a command: only the first failing stage raises one (decision 14). Whether
/// real robots raise several is open (decision 47).
using MotionFault = std::optional<MotionFlag>;

constexpr std::size_t indexOf(MotionFlag flag) noexcept { return static_cast<std::size_t>(flag); }

}  // namespace franka_sim
