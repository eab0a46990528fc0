// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "common.h"

namespace {
constexpr char kDescription[] =
    "Moves the end effector by velocities: down and up again, while it turns about the "
    "vertical.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    constexpr double kDuration = 4, kDown = 0.1, kTurn = 0.3;  // [s] [m] [rad]
    const double before = robot.readOnce().O_T_EE[14];
    double time = 0, lowest = before;
    robot.control([&](const franka::RobotState& state, franka::Duration period) {
      time += period.toSec();
      lowest = std::min(lowest, state.O_T_EE[14]);
      // The derivative of kDown / 2 (1 - cos x), whose angle x itself begins and ends smoothly.
      const double angle = 2 * M_PI * example::smooth(time, kDuration);
      const double s = std::min(time / kDuration, 1.0);
      const double rate = 2 * M_PI * 30 * s * s * (1 - s) * (1 - s) / kDuration;
      const double swing = 0.5 * std::sin(angle) * rate;
      const franka::CartesianVelocities command({0, 0, -kDown * swing, 0, 0, kTurn * swing});
      return time < kDuration ? command : franka::MotionFinished(command);
    });
    std::printf("down %.4f\nback %.4f\n", before - lowest, robot.readOnce().O_T_EE[14] - before);
  });
}
