// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/world_joints.h>

#include <stdexcept>

#include "physics/world/world_impl.h"

namespace franka_sim {

JointMeasurement jointState(const World& world, const std::string& joint) {
  const World::Impl& impl = implOf(world);
  const physics::JointSlot slot = impl.slot(joint);
  return {impl.data->qpos[slot.qpos], impl.data->qvel[slot.dof], impl.motor_side.torque(slot.dof)};
}

void checkJointPosition(const World& world, const std::string& joint, double position) {
  World::Impl& impl = implOf(world);
  impl.slot(joint);
  const int id = mj_name2id(impl.model.get(), mjOBJ_JOINT, joint.c_str());
  impl.requireRuns();
  sizes::check(position, sizes::kMaxPosition, "m or rad", "The position for joint '" + joint + "'");
  const double* range = impl.model->jnt_range + 2 * id;
  if (impl.model->jnt_limited[id] && (position < range[0] || position > range[1])) {
    throw std::runtime_error("Joint '" + joint + "' cannot be put at " +
                             franka_core::numberText(position) + ", its stops are at " +
                             franka_core::numberText(range[0]) + " and " +
                             franka_core::numberText(range[1]) + ".");
  }
}

void setJointPosition(World& world, const std::string& joint, double position) {
  checkJointPosition(world, joint, position);
  World::Impl& impl = implOf(world);
  const physics::JointSlot slot = impl.slot(joint);
  impl.data->qpos[slot.qpos] = position;
  impl.data->qvel[slot.dof] = 0;
  impl.disturb();
  for (auto& [key, arm] : impl.arms) {
    arm->jointWasMoved(joint);
  }
  for (auto& [key, drive] : impl.drives) {
    drive->jointWasMoved(joint);
  }
}

void setJointVelocity(World& world, const std::string& joint, double velocity) {
  World::Impl& impl = implOf(world);
  const physics::JointSlot slot = impl.slot(joint);
  impl.requireRuns();
  sizes::check(velocity, sizes::kMaxVelocity, "m/s or rad/s",
               "The velocity for joint '" + joint + "'");
  impl.data->qvel[slot.dof] = velocity;
  impl.disturb();
}

}  // namespace franka_sim
