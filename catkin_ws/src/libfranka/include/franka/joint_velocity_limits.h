// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <array>
#include <string>

/// @file
/// The FR3's joint velocity limits, which shrink towards the joints' ends.

namespace franka {

/// The joint velocity limits in a robot's description (URDF), without a connection to the robot.
/// Each is franka::kLimitEps smaller than the robot's own, as in Robot's functions of the same
/// names. Thread-safe. Exception: while `parseFromURDF` runs, no other call may run.
class JointVelocityLimitsConfig {
 public:
  /// Allows no velocity until a description has been read.
  JointVelocityLimitsConfig() = default;
  /// @copydoc parseFromURDF
  explicit JointVelocityLimitsConfig(const std::string& urdf);

  /// Reads, for each of joint1 to joint7 (with or without a prefix), `<limit lower upper velocity>`
  /// and `<position_based_velocity_limits velocity_offset deceleration_limit>`. Not real-time safe.
  /// @throws std::runtime_error if one of them is missing or not a number; the object then stays
  /// unchanged.
  void parseFromURDF(const std::string& urdf);

  /// Highest velocities at q [rad/s]. Real-time safe.
  /// @param joint_positions q [rad].
  std::array<double, 7> getUpperJointVelocityLimits(
      const std::array<double, 7>& joint_positions) const noexcept;
  /// Lowest velocities at q [rad/s]. Real-time safe.
  /// @param joint_positions q [rad].
  std::array<double, 7> getLowerJointVelocityLimits(
      const std::array<double, 7>& joint_positions) const noexcept;

 private:
  franka_core::PositionVelocityLimits limits_{};
};

}  // namespace franka
