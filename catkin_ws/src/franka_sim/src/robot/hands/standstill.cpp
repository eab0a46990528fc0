// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/hands/standstill.h>

#include <cmath>

namespace franka_sim {

namespace {

constexpr double kPatience = 0.2;  // [s], chosen here (decision 29)

}  // namespace

void Standstill::restart() noexcept {
  below_ = 0;
  elapsed_ = 0.0;
  counting_ = false;
}

bool Standstill::update(double speed, double threshold, double period, bool commanded) noexcept {
  elapsed_ += period;
  const bool moves = std::abs(speed) > threshold;
  counting_ = counting_ || (moves && commanded) || elapsed_ >= kPatience;
  if (moves || !counting_) {
    below_ = 0;
    return false;
  }
  if (below_ < samples_) {
    below_++;
  }
  return below_ >= samples_;
}

}  // namespace franka_sim
