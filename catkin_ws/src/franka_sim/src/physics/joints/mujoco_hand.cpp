// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/joints/mujoco_hand.h"

#include <cstddef>
#include <utility>

namespace franka_sim::physics {

MujocoHand::MujocoHand(const PlantView* view, std::array<std::string, 2> joints)
    : view_(view), joints_(std::move(joints)) {}

HandMeasurement MujocoHand::measure() const noexcept {
  HandMeasurement result;
  for (std::size_t i = 0; i < 2; ++i) {
    result.q[i] = view_->data->qpos[slots_[i].qpos];
    result.dq[i] = view_->data->qvel[slots_[i].dof];
  }
  return result;
}

void MujocoHand::applyForces(const std::array<double, 2>& force) noexcept {
  for (std::size_t i = 0; i < 2; ++i) {
    view_->data->qfrc_applied[slots_[i].dof] = finiteOrZero(force[i]);
  }
}

}  // namespace franka_sim::physics
