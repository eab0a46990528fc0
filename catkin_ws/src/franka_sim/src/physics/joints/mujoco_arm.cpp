// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/joints/mujoco_arm.h"

#include <utility>

namespace franka_sim::physics {

MujocoArm::MujocoArm(const PlantView* view, std::array<std::string, 7> joints,
                     const std::array<double, 7>& torque_offset)
    : view_(view), joints_(std::move(joints)), torque_offset_(torque_offset) {}

ArmMeasurement MujocoArm::measure() const noexcept {
  ArmMeasurement result;
  for (std::size_t i = 0; i < 7; ++i) {
    result.q[i] = view_->data->qpos[slots_[i].qpos];
    result.dq[i] = view_->data->qvel[slots_[i].dof];
    result.tau_J[i] = view_->motor_side->torque(slots_[i].dof) + torque_offset_[i];
  }
  result.substeps = view_->motor_side->substeps();
  return result;
}

void MujocoArm::applyTorques(const std::array<double, 7>& tau) noexcept {
  for (std::size_t i = 0; i < 7; ++i) {
    view_->data->qfrc_applied[slots_[i].dof] =
        state_.brakes_closed ? 0.0 : finiteOrZero(tau[i]) - torque_offset_[i];
  }
}

void MujocoArm::setBrakes(bool closed) noexcept {
  if (closed == state_.brakes_closed) {
    return;
  }
  state_.brakes_closed = closed;
  for (std::size_t i = 0; i < 7; ++i) {
    state_.brake_positions[i] = view_->data->qpos[slots_[i].qpos];
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
    if (joints_[i] == joint && state_.brakes_closed) {
      state_.brake_positions[i] = view_->data->qpos[slots_[i].qpos];
      writeBrake(i);
    }
  }
}

void MujocoArm::reset() noexcept {
  state_ = {};
  restoreBrakes();
}

void MujocoArm::writeBrake(std::size_t joint) noexcept {
  writeHold(*view_, slots_[joint], state_.brakes_closed, state_.brake_positions[joint]);
}

}  // namespace franka_sim::physics
