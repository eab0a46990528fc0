// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>

#include <array>
#include <cstdint>
#include <random>

namespace franka_control {

/// A robot state in which all fields, and all their elements, have different values.
class RandomStates {
 public:
  franka::RobotState next() {
    franka::RobotState state;
    fill(state.O_T_EE, state.O_T_EE_d, state.O_T_EE_c, state.F_T_EE, state.F_T_NE, state.NE_T_EE,
         state.EE_T_K, state.I_ee, state.F_x_Cee, state.I_load, state.F_x_Cload, state.I_total,
         state.F_x_Ctotal, state.elbow, state.elbow_d, state.elbow_c, state.delbow_c,
         state.ddelbow_c, state.tau_J, state.tau_J_d, state.dtau_J, state.q, state.q_d, state.dq,
         state.dq_d, state.ddq_d, state.joint_contact, state.cartesian_contact,
         state.joint_collision, state.cartesian_collision, state.tau_ext_hat_filtered,
         state.O_F_ext_hat_K, state.K_F_ext_hat_K, state.O_dP_EE_d, state.O_ddP_O, state.O_dP_EE_c,
         state.O_ddP_EE_c, state.theta, state.dtheta);
    state.m_ee = number();
    state.m_load = number();
    state.m_total = number();
    state.control_command_success_rate = number();
    state.time = franka::Duration(static_cast<std::uint64_t>(number() * 1e6 + 2e6));
    state.current_errors = franka::Errors(flags());
    state.last_motion_errors = franka::Errors(flags());
    return state;
  }

 private:
  template <typename... Arrays>
  void fill(Arrays&... arrays) {
    const auto fill_one = [this](auto& array) {
      for (double& value : array) {
        value = number();
      }
    };
    (fill_one(arrays), ...);
  }

  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(generator_); }

  std::array<bool, 41> flags() {
    std::array<bool, 41> result{};
    for (bool& flag : result) {
      flag = number() > 0.0;
    }
    return result;
  }

  std::mt19937 generator_{4711};
};

}  // namespace franka_control
