// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/external_torque.h>
#include <franka_sim/robot/tick.h>

#include <cstddef>

namespace franka_sim {

std::array<double, 7> ExternalTorque::update(const franka_core::ArmModel& model,
                                             const franka_core::Payload& payload,
                                             const std::array<double, 3>& gravity_earth,
                                             const ArmMeasurement& now) noexcept {
  std::array<double, 7> tau_ext{};
  if (has_previous_) {
    std::array<double, 7> q;
    std::array<double, 7> dq;
    std::array<double, 7> ddq;
    for (std::size_t i = 0; i < 7; i++) {
      q[i] = q_[i] + alpha_ * (now.q[i] - q_[i]);
      dq[i] = dq_[i] + alpha_ * (now.dq[i] - dq_[i]);
      ddq[i] = (now.dq[i] - dq_[i]) / kTick;
    }
    const std::array<double, 7> explained =
        model.inverseDynamics(q, dq, ddq, payload, gravity_earth);
    for (std::size_t i = 0; i < 7; i++) {
      tau_ext[i] = now.tau_J[i] - explained[i];
    }
  }
  restart(now);
  return tau_ext;
}

void ExternalTorque::restart(const ArmMeasurement& now) noexcept {
  q_ = now.q;
  dq_ = now.dq;
  has_previous_ = true;
}

}  // namespace franka_sim
