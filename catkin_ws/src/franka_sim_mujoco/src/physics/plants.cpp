// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/plants.h"

#include <cmath>
#include <utility>

namespace franka_sim_mujoco::physics {
namespace {

/// A number that is none would make MuJoCo reset the whole world; no torque is the lesser evil.
double finite(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

}  // namespace

MujocoArm::MujocoArm(const PlantView* view, std::array<std::string, 7> joints)
    : view_(view), joints_(std::move(joints)) {}

ArmMeasurement MujocoArm::measure() const noexcept {
  ArmMeasurement result;
  for (std::size_t i = 0; i < 7; ++i) {
    result.q[i] = view_->data->qpos[slots_[i].qpos];
    result.dq[i] = view_->data->qvel[slots_[i].dof];
    result.tau_J[i] = view_->motor_side->torque(slots_[i].dof);
  }
  return result;
}

void MujocoArm::applyTorques(const std::array<double, 7>& tau) noexcept {
  for (std::size_t i = 0; i < 7; ++i) {
    view_->data->qfrc_applied[slots_[i].dof] = brakes_closed_ ? 0.0 : finite(tau[i]);
  }
}

void MujocoArm::setBrakes(bool closed) noexcept {
  if (closed == brakes_closed_) {
    return;
  }
  brakes_closed_ = closed;
  for (std::size_t i = 0; i < 7; ++i) {
    brake_positions_[i] = view_->data->qpos[slots_[i].qpos];
    if (closed) {
      view_->data->qfrc_applied[slots_[i].dof] = 0.0;
    }
    writeBrake(i);
  }
}

void MujocoArm::restoreBrakes() noexcept {
  for (std::size_t i = 0; i < 7; ++i) {
    writeBrake(i);
  }
}

void MujocoArm::jointWasMoved(const std::string& joint) noexcept {
  for (std::size_t i = 0; i < 7; ++i) {
    if (joints_[i] == joint && brakes_closed_) {
      brake_positions_[i] = view_->data->qpos[slots_[i].qpos];
      writeBrake(i);
    }
  }
}

void MujocoArm::reset() noexcept {
  brakes_closed_ = false;
  brake_positions_ = {};
  restoreBrakes();
}

void MujocoArm::writeBrake(std::size_t joint) noexcept {
  const int brake = slots_[joint].brake;
  if (brake < 0) {
    return;
  }
  // The equality holds q - qpos0 at its constant term.
  view_->model->eq_data[mjNEQDATA * brake] =
      brakes_closed_ ? brake_positions_[joint] - view_->model->qpos0[slots_[joint].qpos] : 0.0;
  view_->model->eq_active[brake] = brakes_closed_ ? 1 : 0;
}

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
    view_->data->qfrc_applied[slots_[i].dof] = finite(force[i]);
  }
}

}  // namespace franka_sim_mujoco::physics
