// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/rest_sequence.h"

namespace franka_sim {

namespace {

constexpr int kYieldTicks = 200;      // duration of yielding after a reflex (decision 16)
constexpr int kReflexTicks = 200;     // then braking restarts (decision 16)
constexpr int kMaxBrakeTicks = 2000;  // an arm at full speed comes to rest within half a second

}  // namespace

void RestSequence::brake(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                         const std::array<double, 7>& ddq_d,
                         const franka_core::ArmLimits& limits) noexcept {
  brake_.start(q_d, dq_d, ddq_d, limits);
  phase_ = Phase::kBraking;
  ticks_ = 0;
}

std::array<double, 7> RestSequence::restingPosition() const noexcept {
  BrakeTrajectory brake = brake_;
  for (int i = 0; i < kMaxBrakeTicks && !brake.atRest(); ++i) {
    brake.step();
  }
  return brake.q();
}

RestSequence::Step RestSequence::step(bool reflex, const std::array<double, 7>& q,
                                      const std::array<double, 7>& dq,
                                      const franka_core::ArmLimits& limits) noexcept {
  if (phase_ == Phase::kReached) {
    return Step::kNone;
  }
  ticks_++;
  if (phase_ == Phase::kYielding) {
    phase_ = ticks_ < kYieldTicks ? Phase::kYielding : Phase::kReached;
    return Step::kYields;
  }
  brake_.step();
  if (reflex && ticks_ == kReflexTicks && !brake_.atRest()) {
    // From here on the arm does not press on an obstacle (decision 16).
    brake_.start(q, dq, {}, limits);
  }
  if (!brake_.atRest()) {
    return Step::kBrakes;
  }
  phase_ = reflex ? Phase::kYielding : Phase::kReached;
  ticks_ = 0;
  return Step::kStops;
}

}  // namespace franka_sim
