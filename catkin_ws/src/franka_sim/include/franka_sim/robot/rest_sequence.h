// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/motion/brake_trajectory.h>

#include <array>

namespace franka_sim {

/// How an arm comes to rest: its desired motion brakes; after a reflex the arm then yields for a
/// while, so that it does not press on what it has met (decision 16). Real-time safe; one thread.
class RestSequence {
 public:
  /// What the desired pose does in a tick.
  enum class Step {
    kNone,    ///< nothing: the arm rests
    kBrakes,  ///< follows braking()
    kStops,   ///< the same, and comes to rest with it
    kYields,  ///< follows the measured pose
  };

  /// Brakes from a desired motion. @param ddq deceleration [rad/s^2]
  void brake(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
             const std::array<double, 7>& ddq) noexcept;
  /// The arm is held where it is.
  void finish() noexcept { phase_ = Phase::kReached; }

  /// One tick. @param reflex whether an error is what the arm brakes for @param q, dq measured
  Step step(bool reflex, const std::array<double, 7>& q, const std::array<double, 7>& dq,
            const std::array<double, 7>& ddq) noexcept;

  bool isBraking() const noexcept { return phase_ == Phase::kBraking; }
  bool isFinished() const noexcept { return phase_ == Phase::kReached; }
  const BrakeTrajectory& braking() const noexcept { return brake_; }

 private:
  enum class Phase { kBraking, kYielding, kReached };

  BrakeTrajectory brake_;
  Phase phase_{Phase::kReached};
  int ticks_{0};
};

}  // namespace franka_sim
