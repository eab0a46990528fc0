// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>
#include <franka_core/robot_error.h>

#include <cstddef>
#include <string>

namespace franka_core {

/// Limits of commanded motions, and the flags that report violations.
struct MotionLimits {
  ArmLimits arm{kFerLimits};      ///< of the arm, far from the joints' ends
  bool position_velocity{false};  ///< joint velocity limits shrink towards the joints' ends (FR3)
  PositionVelocityLimits velocity_near_ends{};  ///< used if position_velocity
  bool own_position_flags{true};                ///< 12 and 27; 0 replaces them from system 5.7.2 on
  bool echoes_floats{false};                    ///< states are sent as 32 bit floats (protocol 10)

  /// Highest velocity of a joint (0 to 6) at position q [rad, rad/s].
  double highestVelocity(std::size_t joint, double q) const noexcept;
  /// Lowest velocity, as highestVelocity.
  double lowestVelocity(std::size_t joint, double q) const noexcept;
  /// Allowed targets of a joint [rad]: within its limits, and where a velocity is allowed.
  JointRange reach(std::size_t joint) const noexcept;
  /// The same for a joint at a position [rad]: it may also stay there, and return from beyond.
  JointRange reachFrom(std::size_t joint, double q) const noexcept;
  /// Why a joint cannot go to a position: "between -2.8973 and 2.8973 rad, not at 3". The range is
  /// rounded inwards, so that its printed ends are allowed. Not real-time safe.
  std::string reachText(std::size_t joint, double q) const;
  /// Bounds of the elbow's motion; of its two velocities the larger one.
  DerivativeLimits elbow() const noexcept;
  /// The flag of a joint position out of range. @param solved found by inverse kinematics
  RobotError positionFlag(bool solved) const noexcept;
};

/// The limits of a robot that speaks this protocol (decisions 8, 25) (protocol 5.5).
/// Protocol 10 takes the velocity limits of system 5.9, which its clients read from the URDF.
MotionLimits motionLimitsOfProtocol(unsigned version) noexcept;

}  // namespace franka_core
