// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/async_joint_generator.h"

#include <franka_core/tick.h>

#include <algorithm>
#include <cmath>

#include "robot/motion/landing_rate.h"

namespace franka_sim {

using franka_core::kTick;

namespace {

constexpr double kShare = 0.999;  // used share of the limits, so that rounding never exceeds them

}  // namespace

void AsyncJointGenerator::start(const std::array<double, 7>& q,
                                const std::array<double, 7>& maximum_velocity) noexcept {
  target_ = q;
  maximum_velocity_ = maximum_velocity;
  q_ = q;
  dq_.fill(0.0);
  history_.fill(q);
  newest_ = 0;
  sample_ = JointSample{};
  sample_.q = q;
  stopping_ = false;
}

void AsyncJointGenerator::step(const franka_core::MotionLimits& limits) noexcept {
  JointSample next;
  newest_ = (newest_ + 1) % kWindow;
  for (std::size_t i = 0; i < 7; i++) {
    const double step = kShare * limits.arm.ddq[i] * kTick;
    const double distance = target_[i] - q_[i];
    const double landing = std::copysign(landingRate(std::abs(distance), step), distance);
    const double up = kShare * std::min(maximum_velocity_[i], limits.highestVelocity(i, q_[i]));
    const double down = kShare * std::max(-maximum_velocity_[i], limits.lowestVelocity(i, q_[i]));
    const double desired = stopping_ ? 0.0 : std::min(std::max(landing, down), up);
    const double before = dq_[i];
    dq_[i] = std::min(std::max(desired, before - step), before + step);
    // The last step sets the target itself, without rounding.
    const bool landed = !stopping_ && dq_[i] == landing && std::abs(landing) <= step;
    q_[i] = landed ? target_[i] : q_[i] + dq_[i] * kTick;
    target_[i] = stopping_ && dq_[i] == 0.0 ? q_[i] : target_[i];
    history_[newest_][i] = q_[i];
    // Differences to the first value keep the mean of equal values exact.
    double mean = 0.0;
    for (const std::array<double, 7>& past : history_) {
      mean += past[i] - q_[i];
    }
    next.q[i] = q_[i] + mean / kWindow;
    next.dq[i] = (next.q[i] - sample_.q[i]) / kTick;
    next.ddq[i] = (next.dq[i] - sample_.dq[i]) / kTick;
    next.dddq[i] = (next.ddq[i] - sample_.ddq[i]) / kTick;
  }
  sample_ = next;
}

bool AsyncJointGenerator::atRest() const noexcept {
  return q_ == target_ && sample_.q == q_ && sample_.dq == std::array<double, 7>{};
}

}  // namespace franka_sim
