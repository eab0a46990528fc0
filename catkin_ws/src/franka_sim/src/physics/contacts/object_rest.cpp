// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/contacts/object_rest.h"

#include <algorithm>
#include <cmath>

namespace franka_sim::physics {
namespace {

// Below it an object stands still [m/s], [rad/s]. Chosen here: a stone on a tray that is tilted by
// 0.1 degrees creeps at twice that; on a level one it is 1e-14 after a second.
constexpr double kStands = 1e-8;
// Ticks. Chosen here: what turns back, as a pendulum, is slow for a shorter time.
constexpr int kLongEnough = 20;

// Whether an equality, which may join anything, joins a robot and an object.
bool joinsRobotAndObject(const mjModel& model, const Ownership& owners, int equality) {
  int bodies[2] = {model.eq_obj1id[equality], model.eq_obj2id[equality]};
  const int type = model.eq_type[equality];
  if (type == mjEQ_JOINT) {
    for (int& id : bodies) {
      id = id < 0 ? -1 : model.jnt_bodyid[id];
    }
  } else if (type != mjEQ_CONNECT && type != mjEQ_WELD) {
    return true;  // not known here
  }
  bool robot = false;
  bool object = false;
  for (const int body : bodies) {
    if (body >= 0) {
      robot = robot || owners.robot_of_body[body] >= 0;
      object = object || (owners.robot_of_body[body] < 0 && model.body_weldid[body] != 0);
    }
  }
  return robot && object;
}

}  // namespace

void ObjectRest::fit(const mjModel& model, const Ownership& owners) {
  owners_ = &owners;
  disturb();
  state_.contacts.clear();
  state_.contacts.reserve(model.nconmax);
  // What drives objects from elsewhere is not looked at.
  possible_ =
      !owners.object_dofs.empty() && model.nmocap == 0 && model.nu == 0 && model.ntendon == 0;
  for (int equality = 0; equality < model.neq; ++equality) {
    possible_ = possible_ && !joinsRobotAndObject(model, owners, equality);
  }
  positions_.clear();
  constexpr int kSizes[] = {7, 4, 1, 1};  // of free, ball, slide and hinge
  for (int joint = 0; joint < model.njnt; ++joint) {
    if (owners.robot_of_body[model.jnt_bodyid[joint]] < 0) {
      for (int i = 0; i < kSizes[model.jnt_type[joint]]; ++i) {
        positions_.push_back(model.jnt_qposadr[joint] + i);
      }
    }
  }
  kept_positions_.assign(positions_.size(), 0.0);
  kept_accelerations_.assign(owners.object_dofs.size(), 0.0);
  kept_torques_.assign(owners.object_dofs.size(), 0.0);
}

bool ObjectRest::restsLongEnough(const mjData& data) noexcept {
  const auto stands = [&data](int dof) {
    return std::abs(data.qvel[dof]) < kStands && data.qfrc_applied[dof] == 0.0;
  };
  if (!possible_ || !used_ ||
      !std::all_of(owners_->object_dofs.begin(), owners_->object_dofs.end(), stands)) {
    state_.rested = 0;
    return false;
  }
  state_.rested = std::min(state_.rested + 1, kLongEnough);
  return state_.rested == kLongEnough;
}

void ObjectRest::startSteps(const mjData& data, const MotorSide& motor_side) noexcept {
  if (!state_.held) {
    return;
  }
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    kept_positions_[i] = data.qpos[positions_[i]];
  }
  for (std::size_t i = 0; i < kept_torques_.size(); ++i) {
    kept_accelerations_[i] = data.qacc_warmstart[owners_->object_dofs[i]];
    kept_torques_[i] = motor_side.torque(owners_->object_dofs[i]);
  }
}

void ObjectRest::finishStep(mjData* data) const noexcept {
  if (!state_.held) {
    return;
  }
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    data->qpos[positions_[i]] = kept_positions_[i];
  }
  for (std::size_t i = 0; i < kept_accelerations_.size(); ++i) {
    const int dof = owners_->object_dofs[i];
    data->qvel[dof] = 0.0;
    data->qacc[dof] = 0.0;
    data->qacc_warmstart[dof] = kept_accelerations_[i];
  }
}

void ObjectRest::finishTick(MotorSide* motor_side) noexcept {
  state_.decided = false;
  if (!state_.held) {
    return;
  }
  for (std::size_t i = 0; i < kept_torques_.size(); ++i) {
    motor_side->setTorque(owners_->object_dofs[i], kept_torques_[i]);
  }
}

}  // namespace franka_sim::physics
