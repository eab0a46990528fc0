// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/laws/torque_blend.h"

#include <franka_core/tick.h>

#include <algorithm>
#include <cstddef>

namespace franka_sim {

namespace {

constexpr double kBlendStep = 1000.0 * franka_core::kTick;  // [Nm] per tick (protocol 5.5)

}  // namespace

std::array<double, 7> TorqueBlend::apply(const std::array<double, 7>& tau) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    if (changing_) {
      offset_[i] = last_[i] - tau[i];
    }
    offset_[i] -= std::clamp(offset_[i], -kBlendStep, kBlendStep);
    last_[i] = tau[i] + offset_[i];
  }
  changing_ = false;
  return last_;
}

void TorqueBlend::restart() noexcept {
  changing_ = false;
  offset_.fill(0.0);
  last_.fill(0.0);
}

}  // namespace franka_sim
