// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <array>

#include "robot/motion/brake_trajectory.h"

namespace franka_sim {

/// Brings an arm to rest: its desired motion brakes; after a reflex the arm then yields for a
/// limited time, so that it does not press on an obstacle (decision 16). Called by one thread.
/// Real-time safe.
class RestSequence {
 public:
  /// The behavior of the desired pose in a tick.
  enum class Step {
    kNone,    ///< nothing: the arm rests
    kBrakes,  ///< follows braking()
    kStops,   ///< the same, and comes to rest in this tick
    kYields,  ///< follows the measured pose
  };

  /// Brakes from a desired motion, as BrakeTrajectory.
  void brake(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
             const std::array<double, 7>& ddq_d, const franka_core::ArmLimits& limits) noexcept;
  /// The arm is held where it is.
  void finish() noexcept { phase_ = Phase::kReached; }

  /// One tick. @param reflex whether the arm brakes because of an error @param q, dq measured
  Step step(bool reflex, const std::array<double, 7>& q, const std::array<double, 7>& dq,
            const franka_core::ArmLimits& limits) noexcept;

  bool isBraking() const noexcept { return phase_ == Phase::kBraking; }
  bool isFinished() const noexcept { return phase_ == Phase::kReached; }
  const BrakeTrajectory& braking() const noexcept { return brake_; }
  /// Where the desired motion, which brakes, comes to rest [rad]. Takes as long as hundreds of
  /// steps.
  std::array<double, 7> restingPosition() const noexcept;

 private:
  enum class Phase { kBraking, kYielding, kReached };

  BrakeTrajectory brake_;
  Phase phase_{Phase::kReached};
  int ticks_{0};
};

}  // namespace franka_sim
