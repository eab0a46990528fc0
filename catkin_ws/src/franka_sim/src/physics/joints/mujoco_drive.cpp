// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/joints/mujoco_drive.h"

#include <cmath>
#include <limits>
#include <utility>

namespace franka_sim::physics {

namespace {

double positiveOrNone(double limit) noexcept {
  return limit > 0.0 ? limit : std::numeric_limits<double>::infinity();
}

}  // namespace

MujocoDrive::MujocoDrive(const PlantView* view, std::string joint)
    : view_(view), joint_{std::move(joint)} {}

JointMeasurement MujocoDrive::measure() const noexcept {
  return {view_->data->qpos[slot_.qpos], view_->data->qvel[slot_.dof],
          view_->motor_side->torque(slot_.dof)};
}

void MujocoDrive::applyEffort(double effort) noexcept {
  state_.follows = false;
  view_->data->qfrc_applied[slot_.dof] = finiteOrZero(effort);
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
