// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "common.h"

namespace {
constexpr char kDescription[] =
    "Moves the end effector on a circle, by poses. The robot solves the inverse kinematics.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    constexpr double kDuration = 5, kRadius = 0.08;  // [s] [m]
    double time = 0, lowest = 1e9, highest = -1e9;
    std::array<double, 16> start{};
    robot.control([&](const franka::RobotState& state, franka::Duration period) {
      if (time == 0) {
        start = state.O_T_EE_c;
      }
      time += period.toSec();
      lowest = std::min(lowest, state.O_T_EE[14]);
      highest = std::max(highest, state.O_T_EE[14]);
      const double angle = 2 * M_PI * example::smooth(time, kDuration);
      franka::CartesianPose command(start);
      command.O_T_EE[13] += kRadius * std::sin(angle);
      command.O_T_EE[14] += kRadius * (1 - std::cos(angle));
      return time < kDuration ? command : franka::MotionFinished(command);
    });
    std::printf("height of the circle %.4f\n", highest - lowest);
  });
}
