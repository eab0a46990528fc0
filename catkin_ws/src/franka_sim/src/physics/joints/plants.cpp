// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/joints/plants.h"

#include <cmath>
#include <limits>
#include <utility>

namespace franka_sim::physics {
namespace {

/// A NaN would make MuJoCo reset the whole world; zero torque is less harmful.
double finite(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

double positiveOrNone(double limit) noexcept {
  return limit > 0.0 ? limit : std::numeric_limits<double>::infinity();
}

/// Closes or opens a joint's brake. The equality holds q - qpos0 at its constant term.
void writeHold(const PlantView& view, const JointSlot& slot, bool closed,
               double position) noexcept {
  if (slot.brake < 0) {
    return;
  }
  mjModel& model = *view.model;
  double& constant = model.eq_data[mjNEQDATA * slot.brake];
  mjtByte& active = model.eq_active[slot.brake];
  const double desired = closed ? position - model.qpos0[slot.qpos] : 0.0;
  if (constant == desired && active == static_cast<mjtByte>(closed)) {
    return;
  }
  if (view.preparation_thread != nullptr) {
    view.preparation_thread->finish();
  }
  constant = desired;
  active = static_cast<mjtByte>(closed);
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
  result.substeps = view_->motor_side->substeps();
  return result;
}

void MujocoArm::applyTorques(const std::array<double, 7>& tau) noexcept {
  for (std::size_t i = 0; i < 7; ++i) {
    view_->data->qfrc_applied[slots_[i].dof] =
        state_.brakes_closed ? 0.0 : finite(tau[i]) - torque_offset_[i];
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
  state_.follows = false;
  view_->data->qfrc_applied[slot_.dof] = finite(effort);
  writeTarget();
}

bool MujocoDrive::follow(double position, const DriveLimits& limits) noexcept {
  if (!std::isfinite(position) || slot_.brake < 0) {
    return false;
  }
  state_.limits = {positiveOrNone(limits.effort), positiveOrNone(limits.velocity)};
  state_.last_target = state_.follows ? state_.target : view_->data->qpos[slot_.qpos];
  state_.follows = true;
  state_.target = position;
  view_->data->qfrc_applied[slot_.dof] = 0.0;
  writeTarget();
  return true;
}

void MujocoDrive::bind(const Slots& slots) noexcept {
  slot_ = slots[0];
  writeTarget();
}

void MujocoDrive::jointWasMoved(const std::string& joint) noexcept {
  if (joint == joint_[0] && state_.follows) {
    state_.target = state_.last_target = view_->data->qpos[slot_.qpos];
    writeTarget();
  }
}

void MujocoDrive::reset() noexcept {
  state_.follows = false;
  writeTarget();
}

void MujocoDrive::prepare(int substep, int substeps) noexcept {
  if (!state_.follows) {
    return;
  }
  const double way = state_.target - state_.last_target;
  writeHold(*view_, slot_, true, state_.target - way * (substeps - substep) / substeps);
  view_->hold_limits->set(slot_.brake, {state_.limits.effort, state_.limits.velocity, way / kTick});
  if (substep == substeps) {
    state_.last_target = state_.target;
  }
}

void MujocoDrive::writeTarget() noexcept {
  writeHold(*view_, slot_, state_.follows, state_.target);
}

}  // namespace franka_sim::physics
