// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/estimator/external_torque.h"

#include <cstddef>

namespace franka_sim {

namespace {

bool same(const franka_core::Payload& one, const franka_core::Payload& other) noexcept {
  return one.mass == other.mass && one.com == other.com && one.inertia == other.inertia;
}

}  // namespace

// M(q) a + c(q, dq) + g(q) at the last sample.
std::array<double, 7> ExternalTorque::atStart(const std::array<double, 7>& ddq) const noexcept {
  std::array<double, 7> torque = constant_;
  for (std::size_t column = 0; column < 7; column++) {
    for (std::size_t row = 0; row < 7; row++) {
      torque[row] += mass_[7 * column + row] * ddq[column];
    }
  }
  return torque;
}

std::array<double, 7> ExternalTorque::update(const franka_core::ArmModel& model,
                                             const franka_core::Payload& payload,
                                             const std::array<double, 3>& gravity_earth,
                                             const ArmMeasurement& now,
                                             const franka_core::ArmDynamics& dynamics) noexcept {
  std::array<double, 7> tau_ext{};
  if (has_previous_) {
    const double alpha = (now.substeps - 1.0) / (2.0 * now.substeps);
    std::array<double, 7> q;
    std::array<double, 7> dq;
    std::array<double, 7> ddq;
    for (std::size_t i = 0; i < 7; i++) {
      q[i] = q_[i] + alpha * (now.q[i] - q_[i]);
      dq[i] = dq_[i] + alpha * (now.dq[i] - dq_[i]);
      ddq[i] = (now.dq[i] - dq_[i]) / kTick;
    }
    const std::array<double, 7> explained =
        now.substeps == 1 && same(payload, payload_)
            ? atStart(ddq)
            : model.inverseDynamics(q, dq, ddq, payload, gravity_earth);
    for (std::size_t i = 0; i < 7; i++) {
      tau_ext[i] = now.tau_J[i] - explained[i];
    }
  }
  restart(payload, now, dynamics);
  return tau_ext;
}

void ExternalTorque::restart(const franka_core::Payload& payload, const ArmMeasurement& now,
                             const franka_core::ArmDynamics& dynamics) noexcept {
  q_ = now.q;
  dq_ = now.dq;
  payload_ = payload;
  mass_ = dynamics.mass;
  for (std::size_t i = 0; i < 7; i++) {
    constant_[i] = dynamics.coriolis[i] + dynamics.gravity[i];
  }
  has_previous_ = true;
}

}  // namespace franka_sim
