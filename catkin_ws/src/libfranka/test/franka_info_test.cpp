// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The command line tool franka_info, run unchanged, and the numbers behind its verdict.
#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "../tools/connection_statistics.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

struct Output {
  int status;
  std::string text;
};

Output info(const std::string& arguments) {
  const std::string command = std::string(LIBFRANKA_INFO) + " " + arguments + " 2>&1";
  FILE* const pipe = popen(command.c_str(), "r");
  Output output{-1, ""};
  std::array<char, 256> line;
  while (pipe != nullptr && std::fgets(line.data(), line.size(), pipe) != nullptr) {
    output.text += line.data();
  }
  const int status = pclose(pipe);
  output.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return output;
}

void expectIn(const std::string& text, const std::string& part) {
  EXPECT_NE(std::string::npos, text.find(part)) << text << "\nlacks: " << part;
}

TEST(FrankaInfo, DescribesTheRobot) {
  FakeRobot panda(5);
  const Output output = info(panda.address() + " 0.2");
  expectIn(output.text, "Panda, control interface version 5 (system 4.2.1 or later");
  expectIn(output.text, "Mode            Idle");
  expectIn(output.text, "Round trip      ");
  expectIn(output.text, "Hand            none");
  expectIn(output.text, "Verdict         ");
  FakeRobot fr3(10);
  expectIn(info(fr3.address() + " 0.2").text, "FR3, control interface version 10");
}

using FrankaInfoRoundTrips = EveryVersion;

TEST_P(FrankaInfoRoundTrips, UseACommandThatChangesNothing) {
  const std::array<double, 16> EE_T_K{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1};
  fake.change([&](franka_core::RobotState& state) { state.EE_T_K = EE_T_K; });
  const Output output = info(fake.address() + " 0.5");
  const bool has_walls = GetParam() <= 5, has_model = GetParam() >= 8;
  const Command command = has_walls   ? Command::kGetCartesianLimit
                          : has_model ? Command::kGetRobotModel
                                      : Command::kSetEEToK;
  const int count = fake.count(command) - (GetParam() == 10 ? 1 : 0);  // one to connect
  EXPECT_GE(count, 1);
  expectIn(output.text, "Round trip      median ");
  expectIn(output.text, " ms (" + std::to_string(count) + " times " +
                            (has_walls   ? "getVirtualWall"
                             : has_model ? "getRobotModel"
                                         : "setK") +
                            " and its answer)");
  for (const auto& request : fake.requests()) {
    const Command sent = franka_core::fci::commandOf(request);
    EXPECT_TRUE(sent == command || sent == Command::kConnect || sent == Command::kGetRobotModel);
    if (const auto* set = std::get_if<franka_core::fci::SetEEToKRequest>(&request)) {
      EXPECT_EQ(EE_T_K, set->EE_T_K);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Some, FrankaInfoRoundTrips, ::testing::Values(5, 7, 10), versionName);

TEST(FrankaInfo, ChangesNothingInARobotThatIsNotIdle) {
  FakeRobot robot(6);
  robot.change([](franka_core::RobotState& state) {
    state.robot_mode = franka_core::RobotMode::kUserStopped;
  });
  expectIn(info(robot.address() + " 0.1").text, "Round trip      not measured (");
  EXPECT_EQ(0, robot.count(Command::kSetEEToK));
}

TEST(FrankaInfo, ReportsWhyARobotIsNotReady) {
  FakeRobot robot(5);
  robot.change([](franka_core::RobotState& s) { s.robot_mode = franka_core::RobotMode::kReflex; });
  const Output output = info(robot.address() + " 0.1");
  EXPECT_EQ(1, output.status);
  expectIn(output.text, "reflex");
}

TEST(FrankaInfo, RefusesInvalidArguments) {
  for (const char* const arguments : {"", "--quick", "a b c", "localhost soon", "localhost -1",
                                      "localhost nan", "localhost 99999"}) {
    const Output output = info(arguments);
    EXPECT_EQ(3, output.status) << arguments;
    expectIn(output.text, "Usage: franka_info [OPTIONS] ADDRESS [SECONDS]");
  }
  const Output refused = info("127.0.0.1:1");
  EXPECT_EQ(2, refused.status);
  expectIn(refused.text, "Connection to FCI refused");
}

TEST(ConnectionStatistics, MeasuresLossAndLateness) {
  franka_info::ConnectionStatistics statistics;
  const auto begin = franka_info::ConnectionStatistics::Clock::now();
  // 1 to 100 ms, without 11 to 15 and 40; each tenth is 3 ms late.
  for (int i = 1; i <= 100; i++) {
    if ((i > 10 && i <= 15) || i == 40) {
      continue;
    }
    const int late = i % 10 == 0 ? 3 : 0;
    statistics.add(franka::Duration(static_cast<std::uint64_t>(i)),
                   begin + std::chrono::milliseconds(i + late));
  }
  EXPECT_EQ(94u, statistics.received());
  EXPECT_EQ(6u, statistics.lost());
  EXPECT_EQ(5u, statistics.mostLostInARow());
  EXPECT_DOUBLE_EQ(0.94, statistics.rate());
  EXPECT_NEAR(0.0, statistics.lateness(0.5), 1e-6);
  EXPECT_NEAR(3.0, statistics.lateness(0.99), 1e-6);
}

TEST(ConnectionStatistics, DetectsARobotThatDoesNotFollowTheClock) {
  const auto begin = franka_info::ConnectionStatistics::Clock::now();
  const auto paceOf = [begin](double factor) {
    franka_info::ConnectionStatistics statistics;
    for (int i = 0; i < 400; i++) {
      const double jitter = i % 7 == 0 ? 4.0 : 0.0;  // [ms]
      const std::chrono::duration<double, std::milli> after(i / factor + jitter);
      statistics.add(
          franka::Duration(static_cast<std::uint64_t>(i)),
          begin + std::chrono::duration_cast<std::chrono::steady_clock::duration>(after));
    }
    EXPECT_NEAR(factor, statistics.pace(), 1e-6 * factor);
    return statistics.keepsTime();
  };
  EXPECT_TRUE(paceOf(1.0));
  EXPECT_TRUE(paceOf(1.0001));
  EXPECT_FALSE(paceOf(0.93));
  EXPECT_FALSE(paceOf(0.5));
  EXPECT_FALSE(paceOf(20.0));
  EXPECT_EQ(1.0, franka_info::ConnectionStatistics().pace());
}

}  // namespace
}  // namespace franka_test
