// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace franka_test {

/// Visits the numbers that a robot sends, in the order of the wire: of franka_core::RobotState or
/// of franka::RobotState, whose fields have the same names. Accelerometers are not among them, and
/// the total load neither, because it is computed.
template <typename State, typename Visit>
void forEachSentField(State& state, Visit visit) {
  visit(state.O_T_EE);
  visit(state.O_T_EE_d);
  visit(state.F_T_EE);
  visit(state.EE_T_K);
  visit(state.F_T_NE);
  visit(state.NE_T_EE);
  visit(state.m_ee);
  visit(state.I_ee);
  visit(state.F_x_Cee);
  visit(state.m_load);
  visit(state.I_load);
  visit(state.F_x_Cload);
  visit(state.elbow);
  visit(state.elbow_d);
  visit(state.tau_J);
  visit(state.tau_J_d);
  visit(state.dtau_J);
  visit(state.q);
  visit(state.q_d);
  visit(state.dq);
  visit(state.dq_d);
  visit(state.ddq_d);
  visit(state.joint_contact);
  visit(state.cartesian_contact);
  visit(state.joint_collision);
  visit(state.cartesian_collision);
  visit(state.tau_ext_hat_filtered);
  visit(state.O_F_ext_hat_K);
  visit(state.K_F_ext_hat_K);
  visit(state.O_dP_EE_d);
  visit(state.O_ddP_O);
  visit(state.elbow_c);
  visit(state.delbow_c);
  visit(state.ddelbow_c);
  visit(state.O_T_EE_c);
  visit(state.O_dP_EE_c);
  visit(state.O_ddP_EE_c);
  visit(state.theta);
  visit(state.dtheta);
  visit(state.control_command_success_rate);
}

/// The numbers of each field.
template <typename State>
std::vector<std::vector<double>> sentValues(const State& state) {
  std::vector<std::vector<double>> values;
  forEachSentField(state, [&values](const auto& field) {
    const double* begin = reinterpret_cast<const double*>(&field);
    values.emplace_back(begin, begin + sizeof(field) / sizeof(double));
  });
  return values;
}

}  // namespace franka_test
