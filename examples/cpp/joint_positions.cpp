// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "common.h"

namespace {
constexpr char kDescription[] =
    "Moves with joint positions: a joint at a time, to the side and back.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    for (std::size_t joint = 0; joint < 7; joint++) {
      std::array<double, 7> goal = example::kReadyPose;
      goal[joint] += 0.2;
      example::moveTo(robot, goal);
      std::printf("joint %zu at %.3f\n", joint + 1, robot.readOnce().q[joint]);
      example::moveTo(robot, example::kReadyPose);
    }
  });
}
