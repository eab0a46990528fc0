// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/motion_log.h"

#include <franka_core/to_franka.h>

#include <algorithm>

namespace franka {

void MotionLog::add(const franka_core::RobotState& state, const franka_core::RobotCommand& command,
                    double answer_time) noexcept {
  if (!ring_.empty()) {
    Entry& entry = ring_[count_ % ring_.size()];
    entry.state = state;
    entry.command = command;
    entry.answer_time = answer_time;
    count_++;
  }
}

std::vector<MotionLog::Entry> MotionLog::entries() const {
  const std::size_t kept = std::min(count_, ring_.size());
  std::vector<Entry> entries;
  entries.reserve(kept);
  for (std::size_t i = count_ - kept; i < count_; i++) {
    entries.push_back(ring_[i % ring_.size()]);
  }
  return entries;
}

std::vector<Record> toRecords(const std::vector<MotionLog::Entry>& entries) {
  std::vector<Record> records(entries.size());
  for (std::size_t i = 0; i < entries.size(); i++) {
    const franka_core::RobotCommand& command = entries[i].command;
    franka_core::toFranka(entries[i].state, records[i].state);
    records[i].command.joint_positions = JointPositions(command.q_c);
    records[i].command.joint_velocities = JointVelocities(command.dq_c);
    records[i].command.cartesian_pose = CartesianPose(command.O_T_EE_c, command.elbow_c);
    records[i].command.cartesian_velocities =
        CartesianVelocities(command.O_dP_EE_c, command.elbow_c);
    records[i].command.torques = Torques(command.tau_J_d);
  }
  return records;
}

}  // namespace franka
