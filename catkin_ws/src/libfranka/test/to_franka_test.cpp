// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Every field of the control unit's state is copied to the public one. Each has a different value,
// so that a missing or mixed-up field is detected.
#include <franka_core/to_franka.h>
#include <gtest/gtest.h>

namespace {

template <std::size_t kSize>
void number(std::array<double, kSize>& values, double& next) {
  for (double& value : values) {
    value = next++;
  }
}

void number(double& value, double& next) { value = next++; }

// One list for both types, whose fields have the same names.
template <typename State, typename Visit>
void forEachField(State& state, Visit visit) {
  visit(state.m_ee);
  visit(state.m_load);
  visit(state.m_total);
  visit(state.control_command_success_rate);
  visit(state.O_T_EE);
  visit(state.O_T_EE_d);
  visit(state.F_T_EE);
  visit(state.F_T_NE);
  visit(state.NE_T_EE);
  visit(state.EE_T_K);
  visit(state.I_ee);
  visit(state.F_x_Cee);
  visit(state.I_load);
  visit(state.F_x_Cload);
  visit(state.I_total);
  visit(state.F_x_Ctotal);
  visit(state.elbow);
  visit(state.elbow_d);
  visit(state.elbow_c);
  visit(state.delbow_c);
  visit(state.ddelbow_c);
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
  visit(state.O_T_EE_c);
  visit(state.O_dP_EE_c);
  visit(state.O_ddP_EE_c);
  visit(state.theta);
  visit(state.dtheta);
}

TEST(ToFranka, CopiesEveryField) {
  franka_core::RobotState from;
  franka::RobotState to, expected;
  double next = 1.0;
  forEachField(from, [&next](auto& field) { number(field, next); });
  next = 1.0;
  forEachField(expected, [&next](auto& field) { number(field, next); });
  // 4 numbers, 7 transforms, 3 inertias, 4 vectors, 5 elbows, 13 joint arrays, 7 twists and
  // wrenches.
  EXPECT_EQ(1.0 + 4 + 7 * 16 + 3 * 9 + 4 * 3 + 5 * 2 + 13 * 7 + 7 * 6, next);
  from.message_id = 987654321;
  from.errors[3] = from.reflex_reason[40] = true;
  from.robot_mode = franka_core::RobotMode::kGuiding;

  franka_core::toFranka(from, to);

  std::vector<std::vector<double>> arrived, sent;
  const auto collectInto = [](std::vector<std::vector<double>>& list) {
    return [&list](const auto& field) {
      const double* begin = reinterpret_cast<const double*>(&field);
      list.emplace_back(begin, begin + sizeof(field) / sizeof(double));
    };
  };
  forEachField(to, collectInto(arrived));
  forEachField(expected, collectInto(sent));
  EXPECT_EQ(sent, arrived);
  EXPECT_EQ(987654321u, to.time.toMSec());
  EXPECT_EQ("[\"joint_velocity_violation\"]", static_cast<std::string>(to.current_errors));
  EXPECT_EQ("[\"base_acceleration_invalid_reading\"]",
            static_cast<std::string>(to.last_motion_errors));
  EXPECT_EQ(franka::RobotMode::kGuiding, to.robot_mode);
}

TEST(ToFranka, ConvertsEveryMode) {
  for (int i = 0; i < 7; i++) {
    EXPECT_EQ(static_cast<franka::RobotMode>(i),
              franka_core::toFranka(static_cast<franka_core::RobotMode>(i)));
  }
}

}  // namespace
