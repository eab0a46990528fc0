// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/robot_state.h>
#include <franka_core/fci/texts.h>

#include "json.h"

namespace franka {

std::ostream& operator<<(std::ostream& ostream, RobotMode robot_mode) {
  const auto mode = static_cast<franka_core::RobotMode>(robot_mode);
  return ostream << "\"" << franka_core::fci::modeName(mode) << "\"";
}

std::ostream& operator<<(std::ostream& ostream, const RobotState& robot_state) {
  ostream << "{\"O_T_EE\": ";
  writeJson(ostream, robot_state.O_T_EE);
  writeMember(ostream, "O_T_EE_d", robot_state.O_T_EE_d);
  writeMember(ostream, "F_T_NE", robot_state.F_T_NE);
  writeMember(ostream, "NE_T_EE", robot_state.NE_T_EE);
  writeMember(ostream, "F_T_EE", robot_state.F_T_EE);
  writeMember(ostream, "EE_T_K", robot_state.EE_T_K);
  writeMember(ostream, "m_ee", robot_state.m_ee);
  writeMember(ostream, "F_x_Cee", robot_state.F_x_Cee);
  writeMember(ostream, "I_ee", robot_state.I_ee);
  writeMember(ostream, "m_load", robot_state.m_load);
  writeMember(ostream, "F_x_Cload", robot_state.F_x_Cload);
  writeMember(ostream, "I_load", robot_state.I_load);
  writeMember(ostream, "m_total", robot_state.m_total);
  writeMember(ostream, "F_x_Ctotal", robot_state.F_x_Ctotal);
  writeMember(ostream, "I_total", robot_state.I_total);
  writeMember(ostream, "elbow", robot_state.elbow);
  writeMember(ostream, "elbow_d", robot_state.elbow_d);
  writeMember(ostream, "elbow_c", robot_state.elbow_c);
  writeMember(ostream, "delbow_c", robot_state.delbow_c);
  writeMember(ostream, "ddelbow_c", robot_state.ddelbow_c);
  writeMember(ostream, "tau_J", robot_state.tau_J);
  writeMember(ostream, "tau_J_d", robot_state.tau_J_d);
  writeMember(ostream, "dtau_J", robot_state.dtau_J);
  writeMember(ostream, "q", robot_state.q);
  writeMember(ostream, "dq", robot_state.dq);
  writeMember(ostream, "q_d", robot_state.q_d);
  writeMember(ostream, "dq_d", robot_state.dq_d);
  writeMember(ostream, "ddq_d", robot_state.ddq_d);
  writeMember(ostream, "joint_contact", robot_state.joint_contact);
  writeMember(ostream, "cartesian_contact", robot_state.cartesian_contact);
  writeMember(ostream, "joint_collision", robot_state.joint_collision);
  writeMember(ostream, "cartesian_collision", robot_state.cartesian_collision);
  writeMember(ostream, "tau_ext_hat_filtered", robot_state.tau_ext_hat_filtered);
  writeMember(ostream, "O_F_ext_hat_K", robot_state.O_F_ext_hat_K);
  writeMember(ostream, "K_F_ext_hat_K", robot_state.K_F_ext_hat_K);
  writeMember(ostream, "O_dP_EE_d", robot_state.O_dP_EE_d);
  writeMember(ostream, "O_ddP_O", robot_state.O_ddP_O);
  writeMember(ostream, "O_T_EE_c", robot_state.O_T_EE_c);
  writeMember(ostream, "O_dP_EE_c", robot_state.O_dP_EE_c);
  writeMember(ostream, "O_ddP_EE_c", robot_state.O_ddP_EE_c);
  writeMember(ostream, "theta", robot_state.theta);
  writeMember(ostream, "dtheta", robot_state.dtheta);
  ostream << ", \"current_errors\": " << robot_state.current_errors;
  ostream << ", \"last_motion_errors\": " << robot_state.last_motion_errors;
  writeMember(ostream, "control_command_success_rate", robot_state.control_command_success_rate);
  ostream << ", \"robot_mode\": " << robot_state.robot_mode;
  return ostream << ", \"time\": " << robot_state.time.toMSec() << "}";
}

}  // namespace franka
