// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>

#include "common.h"

namespace {
constexpr char kDescription[] =
    "A torque controller: springs and dampers at the joints follow a path. Gravity is the "
    "robot's own task; the Coriolis torques come from the model.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    const franka::Model model = robot.loadModel();
    constexpr std::array<double, 7> kStiffness{600, 600, 600, 600, 250, 150, 50};  // [Nm/rad]
    constexpr std::array<double, 7> kDamping{50, 50, 50, 50, 30, 25, 15};          // [Nm s/rad]
    constexpr double kDuration = 4, kWay = 0.2;                                    // [s] [rad]
    double time = 0, largest_error = 0;
    robot.control([&](const franka::RobotState& state, franka::Duration period) {
      time += period.toSec();
      std::array<double, 7> desired = example::kReadyPose;
      desired[3] += kWay * std::sin(2 * M_PI * example::smooth(time, kDuration));
      const std::array<double, 7> coriolis = model.coriolis(state);
      std::array<double, 7> torques;
      for (std::size_t i = 0; i < 7; i++) {
        torques[i] =
            kStiffness[i] * (desired[i] - state.q[i]) - kDamping[i] * state.dq[i] + coriolis[i];
      }
      largest_error = std::max(largest_error, std::abs(desired[3] - state.q[3]));
      const franka::Torques command(torques);
      return time < kDuration ? command : franka::MotionFinished(command);
    });
    std::printf("largest error %.4f\nleft at %.4f\n", largest_error,
                robot.readOnce().q[3] - example::kReadyPose[3]);
  });
}
