// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/hands/finger_force.h>

#include <algorithm>

namespace franka_sim {

namespace {

constexpr double kMaxIntegral = 10.0;  // [N], chosen here: prevents windup of a stuck finger

}  // namespace

double FingerForce::update(double error, double rate_error, double period) noexcept {
  integral_ = std::clamp(integral_ + gains_.i * error * period, -kMaxIntegral, kMaxIntegral);
  return gains_.p * error + integral_ + (gains_.d + kDriveDamping) * rate_error;
}

}  // namespace franka_sim
