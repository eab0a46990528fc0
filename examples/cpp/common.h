// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/exception.h>
#include <franka/robot.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

/// @file
/// Common parts of the examples: their command line, a smooth path, and the motion to the start
/// pose.

namespace example {

/// A pose in front of the robot, away from all limits of a Panda and an FR3 [rad].
constexpr std::array<double, 7> kReadyPose{0, -M_PI_4, 0, -3 * M_PI_4, 0, M_PI_2, M_PI_4};

/// From 0 to 1 within a duration, with zero velocity and acceleration at both ends.
inline double smooth(double time, double duration) {
  const double s = std::clamp(time / duration, 0.0, 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

/// Thresholds that let the arm touch things softly and stop it at harder contacts.
inline void allowContacts(franka::Robot& robot, double torque = 40, double force = 60) {
  std::array<double, 7> torques;
  std::array<double, 6> forces;
  torques.fill(torque);
  forces.fill(force);
  robot.setCollisionBehavior(torques, torques, forces, forces);
}

/// Moves all joints to a position [rad], as slowly as its longest way needs.
inline void moveTo(franka::Robot& robot, const std::array<double, 7>& goal,
                   double speed = 0.6 /* [rad/s] */) {
  const std::array<double, 7> start = robot.readOnce().q_d;
  double longest = 0;
  for (std::size_t i = 0; i < 7; i++) {
    longest = std::max(longest, std::abs(goal[i] - start[i]));
  }
  const double duration = std::max(1.0, 2 * longest / speed);
  double time = 0;
  robot.control([&](const franka::RobotState&, franka::Duration period) {
    time += period.toSec();
    franka::JointPositions command(start);
    for (std::size_t i = 0; i < 7; i++) {
      command.q[i] += smooth(time, duration) * (goal[i] - start[i]);
    }
    return time < duration ? command : franka::MotionFinished(command);
  });
}

/// A robot whose last error is cleared and whose arm is in the start pose.
inline franka::Robot ready(const std::string& address) {
  franka::Robot robot(address);
  robot.automaticErrorRecovery();
  allowContacts(robot);
  moveTo(robot, kReadyPose);
  return robot;
}

/// Runs an example with the robot's address, the only argument. Errors become a message.
/// @param description of the example: --help prints it
inline int run(int argc, char** argv, const char* description,
               const std::function<void(const std::string&)>& example) {
  const std::string word = argc > 1 ? argv[1] : "";
  const bool help = word == "-h" || word == "--help";
  if (help || argc != 2 || word.rfind('-', 0) == 0) {
    std::fprintf(
        help ? stdout : stderr,
        "usage: %s ADDRESS\n\n%s\n\n"
        "ADDRESS is that of a robot, real or simulated. A real robot moves at once: keep the "
        "user stop at hand.\n"
        "Exit status: 0; 1 after an error; 2 for wrong arguments.\n",
        argv[0], description);
    return help ? 0 : 2;
  }
  try {
    example(argv[1]);
    return 0;
  } catch (const franka::Exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace example
