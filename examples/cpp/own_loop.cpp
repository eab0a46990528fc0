// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/active_control_base.h>

#include <memory>

#include "common.h"

namespace {
constexpr char kDescription[] =
    "A motion whose loop belongs to the program: it reads a state and writes a command, "
    "without a callback.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot = example::ready(address);
    constexpr double kDuration = 3, kWay = 0.3;  // [s] [rad]
    const std::unique_ptr<franka::ActiveControlBase> motion = robot.startJointPositionControl(
        research_interface::robot::Move::ControllerMode::kJointImpedance);
    double time = 0;
    std::array<double, 7> start{};
    while (true) {
      const auto [state, period] = motion->readOnce();
      if (time == 0) {
        start = state.q_d;
      }
      time += period.toSec();
      franka::JointPositions command(start);
      command.q[0] += kWay * example::smooth(time, kDuration);
      if (time >= kDuration) {
        motion->writeOnce(franka::MotionFinished(command));
        break;
      }
      motion->writeOnce(command);
    }
    std::printf("joint 1 at %.4f\n", robot.readOnce().q[0]);
  });
}
