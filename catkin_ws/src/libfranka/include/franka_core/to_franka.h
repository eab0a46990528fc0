// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_core/robot_state.h>

/// @file
/// Converts the control unit's state to the public one. Header-only, so that it works with any
/// implementation of franka/robot_state.h; franka_core itself uses no symbol of it.

namespace franka_core {

/// The public value of a mode.
inline franka::RobotMode toFranka(RobotMode mode) noexcept {
  switch (mode) {
    case RobotMode::kOther:
      return franka::RobotMode::kOther;
    case RobotMode::kIdle:
      return franka::RobotMode::kIdle;
    case RobotMode::kMove:
      return franka::RobotMode::kMove;
    case RobotMode::kGuiding:
      return franka::RobotMode::kGuiding;
    case RobotMode::kReflex:
      return franka::RobotMode::kReflex;
    case RobotMode::kUserStopped:
      return franka::RobotMode::kUserStopped;
    case RobotMode::kAutomaticErrorRecovery:
      return franka::RobotMode::kAutomaticErrorRecovery;
  }
  return franka::RobotMode::kOther;
}

/// Copies every field of the public state. Called by the thread that owns `to`. Real-time safe.
/// `time` is the message id in [ms], current_errors are `errors`, last_motion_errors are
/// `reflex_reason`; the total payload is that of the control unit.
inline void toFranka(const RobotState& from, franka::RobotState& to) noexcept {
  to.O_T_EE = from.O_T_EE;
  to.O_T_EE_d = from.O_T_EE_d;
  to.F_T_EE = from.F_T_EE;
  to.F_T_NE = from.F_T_NE;
  to.NE_T_EE = from.NE_T_EE;
  to.EE_T_K = from.EE_T_K;
  to.m_ee = from.m_ee;
  to.I_ee = from.I_ee;
  to.F_x_Cee = from.F_x_Cee;
  to.m_load = from.m_load;
  to.I_load = from.I_load;
  to.F_x_Cload = from.F_x_Cload;
  to.m_total = from.m_total;
  to.I_total = from.I_total;
  to.F_x_Ctotal = from.F_x_Ctotal;
  to.elbow = from.elbow;
  to.elbow_d = from.elbow_d;
  to.elbow_c = from.elbow_c;
  to.delbow_c = from.delbow_c;
  to.ddelbow_c = from.ddelbow_c;
  to.tau_J = from.tau_J;
  to.tau_J_d = from.tau_J_d;
  to.dtau_J = from.dtau_J;
  to.q = from.q;
  to.q_d = from.q_d;
  to.dq = from.dq;
  to.dq_d = from.dq_d;
  to.ddq_d = from.ddq_d;
  to.joint_contact = from.joint_contact;
  to.cartesian_contact = from.cartesian_contact;
  to.joint_collision = from.joint_collision;
  to.cartesian_collision = from.cartesian_collision;
  to.tau_ext_hat_filtered = from.tau_ext_hat_filtered;
  to.O_F_ext_hat_K = from.O_F_ext_hat_K;
  to.K_F_ext_hat_K = from.K_F_ext_hat_K;
  to.O_dP_EE_d = from.O_dP_EE_d;
  to.O_ddP_O = from.O_ddP_O;
  to.O_T_EE_c = from.O_T_EE_c;
  to.O_dP_EE_c = from.O_dP_EE_c;
  to.O_ddP_EE_c = from.O_ddP_EE_c;
  to.theta = from.theta;
  to.dtheta = from.dtheta;
  to.current_errors = franka::Errors(from.errors);
  to.last_motion_errors = franka::Errors(from.reflex_reason);
  to.control_command_success_rate = from.control_command_success_rate;
  to.robot_mode = toFranka(from.robot_mode);
  to.time = franka::Duration(from.message_id);
}

}  // namespace franka_core
