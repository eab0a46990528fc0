// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/hands/width_ramp.h>

#include <algorithm>
#include <cmath>

namespace franka_sim {

namespace {

constexpr double kAcceleration = 1.0;  // [m/s^2] full speed within 0.1 s (chosen here)

}  // namespace

void WidthRamp::start(double width, double target, double speed) noexcept {
  width_ = width;
  target_ = target;
  speed_ = speed;
  velocity_ = 0.0;
}

void WidthRamp::step(double period) noexcept {
  const double remaining = std::abs(target_ - width_);
  const double direction = target_ > width_ ? 1.0 : -1.0;
  const double braking = std::sqrt(2.0 * kAcceleration * remaining);
  const double speed = std::min({speed_, std::abs(velocity_) + kAcceleration * period, braking});
  if (speed * period >= remaining) {
    width_ = target_;
    velocity_ = 0.0;
    return;
  }
  velocity_ = direction * speed;
  width_ += velocity_ * period;
}

}  // namespace franka_sim
