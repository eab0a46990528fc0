// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/gripper_state.h>
#include <franka/robot_state.h>
#include <franka/vacuum_gripper_state.h>
#include <franka_core/to_franka.h>
#include <gtest/gtest.h>

#include <iterator>
#include <limits>
#include <sstream>

#include "state_fields.h"

namespace {

template <typename Type>
std::string textOf(const Type& value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::vector<std::string> keysOf(const std::string& json) {
  std::vector<std::string> keys;
  for (std::size_t at = json.find("\": "); at != std::string::npos;
       at = json.find("\": ", at + 1)) {
    const std::size_t begin = json.rfind('"', at - 1) + 1;
    keys.push_back(json.substr(begin, at - begin));
  }
  return keys;
}

TEST(RobotState, WritesItsMembersInOrder) {
  std::istringstream members(
      "O_T_EE O_T_EE_d F_T_NE NE_T_EE F_T_EE EE_T_K m_ee F_x_Cee I_ee m_load F_x_Cload I_load "
      "m_total F_x_Ctotal I_total elbow elbow_d elbow_c delbow_c ddelbow_c tau_J tau_J_d dtau_J "
      "q dq q_d dq_d ddq_d joint_contact cartesian_contact joint_collision cartesian_collision "
      "tau_ext_hat_filtered O_F_ext_hat_K K_F_ext_hat_K O_dP_EE_d O_ddP_O O_T_EE_c O_dP_EE_c "
      "O_ddP_EE_c theta dtheta current_errors last_motion_errors control_command_success_rate "
      "robot_mode time");
  const std::vector<std::string> expected{std::istream_iterator<std::string>(members), {}};
  EXPECT_EQ(expected, keysOf(textOf(franka::RobotState())));
}

TEST(RobotState, WritesValues) {
  franka::RobotState state;
  state.m_ee = 0.73;
  state.elbow = {0.25, -1.0};
  state.q = {1, 2, 3, 4, 5, 6, std::numeric_limits<double>::quiet_NaN()};
  std::array<bool, 41> flags{};
  flags[6] = true;
  state.last_motion_errors = franka::Errors(flags);
  state.time = franka::Duration(12345);
  state.robot_mode = franka::RobotMode::kAutomaticErrorRecovery;
  const std::string text = textOf(state);
  for (const char* part :
       {"{\"O_T_EE\": [0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0], ", "\"m_ee\": 0.73, ",
        "\"elbow\": [0.25,-1], ", "\"q\": [1,2,3,4,5,6,null], ", "\"current_errors\": [], ",
        "\"last_motion_errors\": [\"joint_reflex\"], ",
        "\"robot_mode\": \"Automatic error recovery\", \"time\": 12345}"}) {
    EXPECT_NE(std::string::npos, text.find(part)) << part << " in " << text;
  }
}

TEST(GripperState, WritesJson) {
  franka::GripperState state;
  state.width = 0.04;
  state.max_width = 0.08;
  state.is_grasped = true;
  state.temperature = 31;
  state.time = franka::Duration(1500);
  EXPECT_EQ(
      "{\"width\": 0.04, \"max_width\": 0.08, \"is_grasped\": true, \"temperature\": 31, \"time\": "
      "1.5}",
      textOf(state));
}

TEST(VacuumGripperState, WritesJson) {
  franka::VacuumGripperState state;
  state.part_present = true;
  state.device_status = franka::VacuumGripperDeviceStatus::kOrange;
  state.vacuum = 700;
  EXPECT_EQ(
      "{\"in_control_range\": false, \"part_detached\": false, \"part_present\": true, "
      "\"device_status\": \"Orange\", \"actual_power\": 0, \"vacuum\": 700, \"time\": 0}",
      textOf(state));
}

// Every field of the control unit's state is copied to the public one. Each has a different value,
// so that a missing or mixed-up field is detected.
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
  const char* names[] = {
      "Other", "Idle", "Move", "Guiding", "Reflex", "User stopped", "Automatic error recovery"};
  for (int i = 0; i < 7; i++) {
    EXPECT_EQ('"' + std::string(names[i]) + '"',
              textOf(franka_core::toFranka(static_cast<franka_core::RobotMode>(i))));
  }
}

}  // namespace
