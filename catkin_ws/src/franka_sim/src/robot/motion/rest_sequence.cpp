// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/rest_sequence.h"

#include <franka_sim/robot/plant.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

// From the rate r the value changes by kTick (r + (r - step) + ...); with n whole steps in r that
// is kTick ((n + 1) r - step n (n + 1) / 2).
double landingRate(double distance, double step) noexcept {
  const double units = distance / (step * kTick);
  const double n = std::floor((std::sqrt(1.0 + 8.0 * units) - 1.0) * 0.5);
  return (distance / kTick + step * n * (n + 1.0) * 0.5) / (n + 1.0);
}

void BrakeTrajectory::start(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                            const std::array<double, 7>& ddq_d,
                            const franka_core::ArmLimits& limits) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    q_[i] = q_d[i];
    dq_[i] = std::isfinite(dq_d[i]) ? dq_d[i] : 0.0;
    ddq_max_[i] = limits.ddq[i];
    change_[i] = limits.dddq[i] * kTick;
    ddq_[i] = std::isfinite(ddq_d[i]) ? std::clamp(ddq_d[i], -ddq_max_[i], ddq_max_[i]) : 0.0;
  }
}

void BrakeTrajectory::step() noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    const double direction = dq_[i] < 0.0 ? -1.0 : 1.0;
    const double landing = landingRate(std::abs(dq_[i]), change_[i]);
    const double braking = std::min({landing, ddq_max_[i], -direction * ddq_[i] + change_[i]});
    // The last step sets 0 itself, without rounding.
    const bool landed = braking == landing && landing <= change_[i];
    const double next = landed ? 0.0 : dq_[i] - direction * braking * kTick;
    ddq_[i] = (next - dq_[i]) / kTick;
    dq_[i] = next;
    q_[i] += next * kTick;
  }
}

bool BrakeTrajectory::atRest() const noexcept {
  const auto zero = [](double v) { return v == 0.0; };
  return std::all_of(dq_.begin(), dq_.end(), zero) && std::all_of(ddq_.begin(), ddq_.end(), zero);
}

namespace {

constexpr int kYieldTicks = 200;   // duration of yielding after a reflex (decision 16)
constexpr int kReflexTicks = 200;  // then braking restarts (decision 16)

}  // namespace

void RestSequence::brake(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                         const std::array<double, 7>& ddq_d,
                         const franka_core::ArmLimits& limits) noexcept {
  brake_.start(q_d, dq_d, ddq_d, limits);
  phase_ = Phase::kBraking;
  ticks_ = 0;
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
