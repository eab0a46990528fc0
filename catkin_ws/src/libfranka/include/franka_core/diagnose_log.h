// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/log.h>
#include <franka_core/abort_diagnosis.h>
#include <franka_core/robot_error.h>

#include <cstddef>
#include <string>
#include <vector>

/// @file
/// The diagnosis for the log of a franka::ControlException of any libfranka. Header-only, so that
/// it can be compiled against the vendor's library.

namespace franka_core {

/// Converts a public record, as far as the diagnosis needs it.
inline AbortRecord toAbortRecord(const franka::Record& record,
                                 const std::array<bool, kErrorCount>& reflex_reason) {
  AbortRecord result;
  const franka::RobotState& from = record.state;
  RobotState& to = result.state;
  to.message_id = from.time.toMSec();
  to.q = from.q;
  to.dq = from.dq;
  to.q_d = from.q_d;
  to.dq_d = from.dq_d;
  to.ddq_d = from.ddq_d;
  to.tau_J = from.tau_J;
  to.tau_J_d = from.tau_J_d;
  to.O_T_EE = from.O_T_EE;
  to.O_T_EE_d = from.O_T_EE_d;
  to.O_T_EE_c = from.O_T_EE_c;
  to.O_dP_EE_c = from.O_dP_EE_c;
  to.O_ddP_EE_c = from.O_ddP_EE_c;
  to.elbow_c = from.elbow_c;
  to.delbow_c = from.delbow_c;
  to.ddelbow_c = from.ddelbow_c;
  to.joint_collision = from.joint_collision;
  to.cartesian_collision = from.cartesian_collision;
  to.tau_ext_hat_filtered = from.tau_ext_hat_filtered;
  to.O_F_ext_hat_K = from.O_F_ext_hat_K;
  to.control_command_success_rate = from.control_command_success_rate;
  to.reflex_reason = reflex_reason;
  result.command.q_c = record.command.joint_positions.q;
  result.command.dq_c = record.command.joint_velocities.dq;
  result.command.O_T_EE_c = record.command.cartesian_pose.O_T_EE;
  result.command.O_dP_EE_c = record.command.cartesian_velocities.O_dP_EE;
  // Both generators have the same elbow; zeros if none was commanded.
  result.command.elbow_c = record.command.cartesian_pose.elbow;
  result.command.valid_elbow = result.command.elbow_c[0] != 0.0 || result.command.elbow_c[1] != 0.0;
  result.command.tau_J_d = record.command.torques.tau_J;
  return result;
}

/// Like diagnoseAbort. The flags are parsed from the names in the text of last_motion_errors.
inline std::vector<std::string> diagnoseLog(const std::vector<franka::Record>& log,
                                            unsigned version) {
  std::vector<AbortRecord> records;
  for (const franka::Record& record : log) {
    const std::string names = static_cast<std::string>(record.state.last_motion_errors);
    std::array<bool, kErrorCount> flags{};
    for (std::size_t i = 0; i < kErrorCount; i++) {
      flags[i] = names.find("\"" + std::string(kErrorNames[i]) + "\"") != std::string::npos;
    }
    records.push_back(toAbortRecord(record, flags));
  }
  return diagnoseAbort(records, version);
}

}  // namespace franka_core
