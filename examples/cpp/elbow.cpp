// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "common.h"

namespace {
constexpr char kDescription[] =
    "Swings the elbow to the side while the end effector stays where it is.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    constexpr double kDuration = 5, kSwing = 0.25;  // [s] [rad]
    double time = 0, elbow_moved = 0, hand_moved = 0;
    std::array<double, 16> pose{};
    std::array<double, 2> elbow{};
    robot.control([&](const franka::RobotState& state, franka::Duration period) {
      if (time == 0) {
        pose = state.O_T_EE_c;
        elbow = state.elbow_c;
      }
      time += period.toSec();
      elbow_moved = std::max(elbow_moved, std::abs(state.elbow[0] - elbow[0]));
      hand_moved =
          std::max(hand_moved, std::hypot(state.O_T_EE[12] - pose[12], state.O_T_EE[13] - pose[13],
                                          state.O_T_EE[14] - pose[14]));
      const double swing = std::sin(2 * M_PI * example::smooth(time, kDuration));
      const franka::CartesianPose command(pose, {elbow[0] + kSwing * swing, elbow[1]});
      return time < kDuration ? command : franka::MotionFinished(command);
    });
    std::printf("elbow %.4f\nend effector %.4f\n", elbow_moved, hand_moved);
  });
}
