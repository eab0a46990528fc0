// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/control_types.h>

#include "common.h"

namespace {
constexpr char kDescription[] =
    "Provokes a reflex by a jump in the commanded positions, prints the exception, "
    "recovers and moves on.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    double time = 0;
    try {
      robot.control(
          [&](const franka::RobotState& state, franka::Duration period) {
            time += period.toSec();
            franka::JointPositions command(state.q_d);
            command.q[6] += time > 0.1 ? 0.05 : 0.0;  // without a way from here to there
            return command;
          },
          franka::ControllerMode::kJointImpedance, false, franka::kMaxCutoffFrequency);
    } catch (const franka::ControlException& error) {
      std::printf("aborted: %s\n", error.what());
      std::printf("states in the log: %zu\n", error.log.size());
    }
    std::printf("reflex: %d\n", robot.readOnce().robot_mode == franka::RobotMode::kReflex);
    robot.automaticErrorRecovery();
    std::printf("idle: %d\n", robot.readOnce().robot_mode == franka::RobotMode::kIdle);
    example::moveTo(robot, example::kReadyPose);
    std::printf("moves again\n");
  });
}
