// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "common.h"

namespace {
constexpr char kDescription[] =
    "Reads the robot's state for a second and prints where the arm is. Moves nothing.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot(address, franka::RealtimeConfig::kIgnore);
    std::printf("protocol %d\n", robot.serverVersion());
    int states = 0;
    franka::RobotState last;
    robot.read([&](const franka::RobotState& state) {
      last = state;
      return ++states < 1000;
    });
    std::printf("states %d\n", states);
    std::printf("q");
    for (const double q : last.q) {
      std::printf(" %.4f", q);
    }
    std::printf("\nend effector %.4f %.4f %.4f\n", last.O_T_EE[12], last.O_T_EE[13],
                last.O_T_EE[14]);
  });
}
