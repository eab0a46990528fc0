// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/log.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace {

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) {
    parts.push_back(part);
  }
  return parts;
}

TEST(Log, EmptyLogGivesEmptyText) { EXPECT_EQ("", franka::logToCSV({})); }

TEST(Log, HasAColumnForEachValue) {
  franka::Record record;
  record.state.time = franka::Duration(12345678);
  record.state.control_command_success_rate = 0.5;
  record.state.tau_ext_hat_filtered[6] = 6.5;
  record.command.cartesian_pose.O_T_EE[15] = 1.0;
  record.command.torques.tau_J = {1, 2, 3, 4, 5, 6, 7.25};
  const std::vector<std::string> lines = split(franka::logToCSV({record, record}), '\n');
  ASSERT_EQ(3u, lines.size());
  const std::vector<std::string> names = split(lines[0], ',');
  const std::vector<std::string> values = split(lines[1], ',');
  ASSERT_EQ(2u + 6 * 7 + 7 + 7 + 16 + 6 + 7, names.size());
  ASSERT_EQ(names.size(), values.size());
  EXPECT_EQ(0u, lines[0].find("time,success_rate,state.q[0],state.q[1],"));
  const auto value = [&](const std::string& name) {
    return values[std::find(names.begin(), names.end(), name) - names.begin()];
  };
  EXPECT_EQ("12345678", value("time"));
  EXPECT_EQ("0.5", value("success_rate"));
  EXPECT_EQ("6.5", value("state.tau_ext_hat_filtered[6]"));
  EXPECT_EQ("1", value("cmd.O_T_EE_d[15]"));
  EXPECT_EQ("7.25", value("cmd.tau_J_d[6]"));
}

}  // namespace
