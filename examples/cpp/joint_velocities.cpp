// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "common.h"

namespace {
constexpr char kDescription[] =
    "Moves with joint velocities: the last four joints swing once, with the speed of a raised "
    "cosine.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    constexpr double kDuration = 4, kMaxVelocity = 0.4;  // [s] [rad/s]
    const std::array<double, 7> before = robot.readOnce().q;
    double time = 0, fastest = 0;
    robot.control([&](const franka::RobotState& state, franka::Duration period) {
      time += period.toSec();
      // One period to one side, the next one back.
      const double phase = 2 * M_PI * time / (kDuration / 2);
      const double side = time < kDuration / 2 ? 1 : -1;
      const double speed = side * kMaxVelocity * 0.5 * (1 - std::cos(phase));
      fastest = std::max(fastest, std::abs(state.dq[6]));
      franka::JointVelocities command({0, 0, 0, speed / 2, speed, speed, speed});
      if (time >= kDuration) {
        return franka::MotionFinished(franka::JointVelocities({0, 0, 0, 0, 0, 0, 0}));
      }
      return command;
    });
    std::printf("fastest %.3f\nmoved %.4f\n", fastest, robot.readOnce().q[6] - before[6]);
  });
}
