// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/world/state_transfer.h"

#include <algorithm>

namespace franka_sim::physics {

namespace {

int positions(int joint_type) {
  return joint_type == mjJNT_FREE ? 7 : joint_type == mjJNT_BALL ? 4 : 1;
}

int velocities(int joint_type) {
  return joint_type == mjJNT_FREE ? 6 : joint_type == mjJNT_BALL ? 3 : 1;
}

/// The joint in `to` that is joint `j` of `from`, or -1.
int counterpart(const mjModel& from, int j, const mjModel& to) {
  if (const char* name = mj_id2name(&from, mjOBJ_JOINT, j)) {
    return mj_name2id(&to, mjOBJ_JOINT, name);
  }
  const int from_body = from.jnt_bodyid[j];
  const char* body_name = mj_id2name(&from, mjOBJ_BODY, from_body);
  const int to_body = body_name != nullptr ? mj_name2id(&to, mjOBJ_BODY, body_name) : from_body;
  const int nth = j - from.body_jntadr[from_body];
  if (to_body < 0 || to_body >= to.nbody || nth >= to.body_jntnum[to_body]) {
    return -1;
  }
  return to.body_jntadr[to_body] + nth;
}

void carryJoint(const mjModel& from, const mjData& source, int j, const mjModel& to, int k,
                mjData* target) {
  const int type = from.jnt_type[j];
  if (k < 0 || to.jnt_type[k] != type) {
    return;
  }
  std::copy_n(source.qpos + from.jnt_qposadr[j], positions(type), target->qpos + to.jnt_qposadr[k]);
  const int from_dof = from.jnt_dofadr[j];
  const int to_dof = to.jnt_dofadr[k];
  std::copy_n(source.qvel + from_dof, velocities(type), target->qvel + to_dof);
  std::copy_n(source.qacc_warmstart + from_dof, velocities(type), target->qacc_warmstart + to_dof);
  std::copy_n(source.qfrc_applied + from_dof, velocities(type), target->qfrc_applied + to_dof);
}

}  // namespace

void carryState(const mjModel& from, const mjData& from_data, const mjModel& to, mjData* to_data) {
  for (int j = 0; j < from.njnt; ++j) {
    carryJoint(from, from_data, j, to, counterpart(from, j, to), to_data);
  }
  // World files come first and robots have neither, so indices do not change.
  std::copy_n(from_data.mocap_pos, 3 * std::min(from.nmocap, to.nmocap), to_data->mocap_pos);
  std::copy_n(from_data.mocap_quat, 4 * std::min(from.nmocap, to.nmocap), to_data->mocap_quat);
  std::copy_n(from_data.act, std::min(from.na, to.na), to_data->act);
  std::copy_n(from_data.ctrl, std::min(from.nu, to.nu), to_data->ctrl);
  to_data->time = from_data.time;
}

}  // namespace franka_sim::physics
