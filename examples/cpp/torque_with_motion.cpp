// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>

#include "common.h"

namespace {
constexpr char kDescription[] =
    "A motion generator of the robot together with one's own torque controller: the robot "
    "turns poses into desired joint positions, which the program's springs follow.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    const franka::Model model = robot.loadModel();
    constexpr double kDuration = 4, kWay = 0.1;  // [s] [m]
    double time = 0, largest_error = 0;
    std::array<double, 16> start{};
    const auto torques = [&](const franka::RobotState& state, franka::Duration) {
      constexpr std::array<double, 7> kStiffness{600, 600, 600, 600, 250, 150, 50};  // [Nm/rad]
      constexpr std::array<double, 7> kDamping{50, 50, 50, 50, 30, 25, 15};          // [Nm s/rad]
      const std::array<double, 7> coriolis = model.coriolis(state);
      franka::Torques command({0, 0, 0, 0, 0, 0, 0});
      for (std::size_t i = 0; i < 7; i++) {
        command.tau_J[i] = kStiffness[i] * (state.q_d[i] - state.q[i]) +
                           kDamping[i] * (state.dq_d[i] - state.dq[i]) + coriolis[i];
      }
      return command;
    };
    const auto pose = [&](const franka::RobotState& state, franka::Duration period) {
      if (time == 0) {
        start = state.O_T_EE_c;
      }
      time += period.toSec();
      largest_error = std::max(largest_error, std::abs(state.O_T_EE_d[13] - state.O_T_EE[13]));
      franka::CartesianPose command(start);
      command.O_T_EE[13] += kWay * std::sin(2 * M_PI * example::smooth(time, kDuration));
      return time < kDuration ? command : franka::MotionFinished(command);
    };
    robot.control(torques, pose);
    std::printf("largest error %.4f\n", largest_error);
  });
}
