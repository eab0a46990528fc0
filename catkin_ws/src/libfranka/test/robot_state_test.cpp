// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/gripper_state.h>
#include <franka/robot_state.h>
#include <franka/vacuum_gripper_state.h>
#include <gtest/gtest.h>

#include <iterator>
#include <limits>
#include <sstream>

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

TEST(RobotState, ModesHaveTheNumbersOfTheProtocol) {
  const char* names[] = {
      "Other", "Idle", "Move", "Guiding", "Reflex", "User stopped", "Automatic error recovery"};
  for (int i = 0; i < 7; i++) {
    EXPECT_EQ('"' + std::string(names[i]) + '"', textOf(static_cast<franka::RobotMode>(i)));
  }
  EXPECT_EQ(franka::RobotMode::kUserStopped, franka::RobotState().robot_mode);
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

}  // namespace
