// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/joints/joint_frictions.h"

#include <algorithm>
#include <cmath>

namespace franka_sim::physics {

namespace {

/// Way of a joint until its motor side slips. Chosen here: the resolution at which users see poses.
constexpr double kSlipsAfter = 1e-4;  // [rad]

double sigmoid(double x) noexcept { return 1.0 / (1.0 + std::exp(-x)); }

double linkSide(const JointFrictions::Joint& joint, double dq) noexcept {
  const JointFriction& law = joint.law;
  const double viscous = law.viscous * dq;
  return law.amplitude == 0.0
             ? viscous
             : viscous + law.amplitude * sigmoid(law.slope * (dq + law.offset)) - joint.at_rest;
}

double motorSide(JointFrictions::Joint& joint, double dq, double period) noexcept {
  const double coulomb = joint.law.coulomb;
  joint.held = std::clamp(joint.held + joint.stiffness * dq * period, -coulomb, coulomb);
  return std::clamp(joint.held + joint.damping * dq, -coulomb, coulomb) + joint.law.damping * dq;
}

}  // namespace

void JointFrictions::add(const mjModel& model, const std::string& joint, const JointFriction& law) {
  Joint added;
  added.name = joint;
  added.dof = model.jnt_dofadr[mj_name2id(&model, mjOBJ_JOINT, joint.c_str())];
  added.law = law;
  added.at_rest = law.amplitude * sigmoid(law.slope * law.offset);
  added.stiffness = law.coulomb / kSlipsAfter;
  // Damps the lightest arm that can hang on the joint, which is the motor alone, critically.
  added.damping = 2.0 * std::sqrt(added.stiffness * model.dof_armature[added.dof]);
  const double steepest =
      added.damping + law.viscous + law.damping + 0.25 * law.amplitude * law.slope;
  if (steepest > 0.0) {
    longest_step_ = std::min(longest_step_, model.dof_armature[added.dof] / steepest);
  }
  joints_.push_back(added);
}

void JointFrictions::carry(const JointFrictions& others) {
  for (Joint& joint : joints_) {
    const auto same = std::find_if(others.joints_.begin(), others.joints_.end(),
                                   [&](const Joint& other) { return other.name == joint.name; });
    if (same != others.joints_.end()) {
      joint.held = same->held;
      joint.motor_side = same->motor_side;
    }
  }
}

void JointFrictions::reset() noexcept {
  for (Joint& joint : joints_) {
    joint.held = 0.0;
    joint.motor_side = 0.0;
  }
}

void JointFrictions::apply(const mjModel& model, mjData* data) noexcept {
  for (Joint& joint : joints_) {
    const double dq = data->qvel[joint.dof];
    joint.motor_side = motorSide(joint, dq, model.opt.timestep);
    data->qfrc_passive[joint.dof] -= linkSide(joint, dq) + joint.motor_side;
  }
}

}  // namespace franka_sim::physics
