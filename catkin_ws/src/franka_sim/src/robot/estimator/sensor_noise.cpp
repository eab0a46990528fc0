// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/estimator/sensor_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

namespace {

constexpr std::array<double, 7> kNone{};
constexpr double kFullRipple = 0.05;  // [rad/s], chosen here
constexpr double kPeakOfRms = 1.41421356237309505;
constexpr double kTurn = 2.0 * 3.14159265358979324;  // [rad]

}  // namespace

SensorNoise::SensorNoise(const SensorPhysics& physics) noexcept
    : physics_(physics),
      noisy_torque_(physics.tau_J_noise != kNone || physics.tau_J_resolution != kNone ||
                    physics.tau_J_ripple != kNone),
      noisy_velocity_(physics.dq_noise != kNone),
      engine_(physics.seed) {}

std::array<double, 7> SensorNoise::torques(const std::array<double, 7>& tau_J,
                                           const std::array<double, 7>& dq) noexcept {
  if (!noisy_torque_) {
    return tau_J;
  }
  std::array<double, 7> reading = noisy(tau_J, physics_.tau_J_noise);
  ticks_++;
  for (std::size_t i = 0; i < 7; i++) {
    if (physics_.tau_J_ripple[i] > 0.0) {
      const double moves = std::min(1.0, std::abs(dq[i]) / kFullRipple);
      const double turns = physics_.ripple_frequency[i] * kTick * static_cast<double>(ticks_);
      reading[i] += kPeakOfRms * physics_.tau_J_ripple[i] * moves * std::sin(kTurn * turns);
    }
    const double resolution = physics_.tau_J_resolution[i];
    if (resolution > 0.0) {
      reading[i] = resolution * std::round(reading[i] / resolution);
    }
  }
  return reading;
}

std::array<double, 7> SensorNoise::velocities(const std::array<double, 7>& dq) noexcept {
  return noisy_velocity_ ? noisy(dq, physics_.dq_noise) : dq;
}

std::array<double, 7> SensorNoise::noisy(std::array<double, 7> values,
                                         const std::array<double, 7>& deviation) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    values[i] += deviation[i] * normal_(engine_);
  }
  return values;
}

void SensorNoise::restart() noexcept {
  engine_.seed(physics_.seed);
  normal_.reset();
  ticks_ = 0;
}

}  // namespace franka_sim
