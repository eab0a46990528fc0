// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/limits.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "panda_arm.h"

namespace franka_sim::test {

/// Follows sine waves about the ready pose by computed torques without gravity, like a user's
/// controller. Phases differ, so that speeds and accelerations occur in all combinations; starts
/// softly.
class SineDriver {
 public:
  /// @param frequency [rad/s] @param fraction of the speed limits that is reached
  SineDriver(const ControlUnitParameters& parameters, const franka_core::Payload& payload,
             double frequency, double fraction,
             const std::array<double, 7>& limit = franka_core::kFerLimits.dq)
      : model_(parameters.model),
        payload_(payload),
        rotor_inertia_(parameters.rotor_inertia),
        frequency_(frequency),
        limit_(limit) {
    for (std::size_t i = 0; i < 7; i++) {
      amplitude_[i] = fraction * limit[i] / frequency * (i % 2 == 0 ? 1.0 : -1.0);
    }
  }

  franka_core::RobotCommand command(const franka_core::RobotState& state) {
    time_ += 1e-3;
    const double ramp = std::min(time_ / 2.0, 1.0);
    std::array<double, 7> ddq;
    for (std::size_t i = 0; i < 7; i++) {
      const double start = 0.7 * static_cast<double>(i);
      const double phase = frequency_ * time_ + start;
      const double a = ramp * amplitude_[i];
      const double q_d = kReady[i] + a * std::sin(phase);
      const double dq_d = a * frequency_ * std::cos(phase);
      ddq[i] = -a * frequency_ * frequency_ * std::sin(phase) + 400 * (q_d - state.q[i]) +
               40 * (dq_d - state.dq[i]);
    }
    franka_core::RobotCommand command;
    command.tau_J_d = model_.inverseDynamics(state.q, state.dq, ddq, payload_, {{0, 0, 0}});
    for (std::size_t i = 0; i < 7; i++) {
      command.tau_J_d[i] += rotor_inertia_[i] * ddq[i];
    }
    return command;
  }

  const std::array<double, 7>& limit() const { return limit_; }

 private:
  franka_core::ArmModel model_;
  franka_core::Payload payload_;
  std::array<double, 7> rotor_inertia_;
  double frequency_;
  double time_{0.0};
  std::array<double, 7> limit_;
  std::array<double, 7> amplitude_{};
};

}  // namespace franka_sim::test
