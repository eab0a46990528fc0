// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Every field of the control unit's state is copied to the public one. Each has a different value,
// so that a missing or mixed-up field is detected.
#include <franka_core/to_franka.h>
#include <gtest/gtest.h>

#include "state_fields.h"

namespace {

template <std::size_t kSize>
void number(std::array<double, kSize>& values, double& next) {
  for (double& value : values) {
    value = next++;
  }
}

void number(double& value, double& next) { value = next++; }

template <typename State, typename Visit>
void forEachField(State& state, Visit visit) {
  franka_test::forEachSentField(state, visit);
  visit(state.m_total);
  visit(state.I_total);
  visit(state.F_x_Ctotal);
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

  EXPECT_EQ(franka_test::sentValues(expected), franka_test::sentValues(to));
  EXPECT_EQ(expected.m_total, to.m_total);
  EXPECT_EQ(expected.I_total, to.I_total);
  EXPECT_EQ(expected.F_x_Ctotal, to.F_x_Ctotal);
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
