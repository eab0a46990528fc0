// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/plants.h"

#include <cmath>
#include <utility>

namespace franka_sim::physics {
namespace {

/// A NaN would make MuJoCo reset the whole world; zero torque is less harmful.
double finite(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

/// Closes or opens a joint's brake. The equality holds q - qpos0 at its constant term.
void writeHold(mjModel& model, const JointSlot& slot, bool closed, double position) noexcept {
  if (slot.brake < 0) {
    return;
  }
  model.eq_data[mjNEQDATA * slot.brake] = closed ? position - model.qpos0[slot.qpos] : 0.0;
  model.eq_active[slot.brake] = closed ? 1 : 0;
}

}  // namespace

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
  return result;
}

void MujocoArm::applyTorques(const std::array<double, 7>& tau) noexcept {
  for (std::size_t i = 0; i < 7; ++i) {
    view_->data->qfrc_applied[slots_[i].dof] =
        brakes_closed_ ? 0.0 : finite(tau[i]) - torque_offset_[i];
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
  writeHold(*view_->model, slots_[joint], brakes_closed_, brake_positions_[joint]);
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

MujocoDrive::MujocoDrive(const PlantView* view, std::string joint)
    : view_(view), joint_{std::move(joint)} {}

JointMeasurement MujocoDrive::measure() const noexcept {
  return {view_->data->qpos[slot_.qpos], view_->data->qvel[slot_.dof],
          view_->motor_side->torque(slot_.dof)};
}

void MujocoDrive::applyEffort(double effort) noexcept {
  follows_ = false;
  view_->data->qfrc_applied[slot_.dof] = finite(effort);
  writeTarget();
}

void MujocoDrive::follow(double position) noexcept {
  if (!std::isfinite(position)) {
    return;
  }
  last_target_ = follows_ ? target_ : view_->data->qpos[slot_.qpos];
  follows_ = true;
  target_ = position;
  view_->data->qfrc_applied[slot_.dof] = 0.0;
  writeTarget();
}

void MujocoDrive::bind(const Slots& slots) noexcept {
  slot_ = slots[0];
  writeTarget();
}

void MujocoDrive::jointWasMoved(const std::string& joint) noexcept {
  if (joint == joint_[0] && follows_) {
    target_ = last_target_ = view_->data->qpos[slot_.qpos];
    writeTarget();
  }
}

void MujocoDrive::reset() noexcept {
  follows_ = false;
  writeTarget();
}

void MujocoDrive::prepare(int substep, int substeps) noexcept {
  if (!follows_) {
    return;
  }
  const double way = target_ - last_target_;
  writeHold(*view_->model, slot_, true, target_ - way * (substeps - substep) / substeps);
  if (substep == substeps) {
    last_target_ = target_;
  }
}

void MujocoDrive::writeTarget() noexcept { writeHold(*view_->model, slot_, follows_, target_); }

}  // namespace franka_sim::physics
