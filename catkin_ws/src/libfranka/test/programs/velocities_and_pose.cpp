// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Joint and Cartesian velocities, and a Cartesian pose, in sequence.
#include <franka/exception.h>
#include <franka/robot.h>

#include <cmath>
#include <iostream>

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "Usage: " << argv[0] << " <robot-hostname>" << std::endl;
    return -1;
  }
  try {
    franka::Robot robot(argv[1], franka::RealtimeConfig::kIgnore);
    const double time_max = 0.2;
    double time = 0.0;
    robot.control(
        [=, &time](const franka::RobotState&, franka::Duration period) -> franka::JointVelocities {
          time += period.toSec();
          const double omega = 0.1 * std::sin(M_PI * time / time_max);
          franka::JointVelocities velocities = {{0.0, 0.0, 0.0, omega, omega, omega, omega}};
          if (time >= time_max) {
            return franka::MotionFinished(velocities);
          }
          return velocities;
        });

    time = 0.0;
    robot.control(
        [=, &time](const franka::RobotState&,
                   franka::Duration period) -> franka::CartesianVelocities {
          time += period.toSec();
          const double v = 0.02 * std::sin(M_PI * time / time_max);
          franka::CartesianVelocities output = {{v, 0.0, -v, 0.0, 0.0, 0.0}};
          if (time >= time_max) {
            return franka::MotionFinished(output);
          }
          return output;
        },
        franka::ControllerMode::kCartesianImpedance);

    time = 0.0;
    std::array<double, 16> initial_pose;
    robot.control(
        [&time, &initial_pose, time_max](const franka::RobotState& robot_state,
                                         franka::Duration period) -> franka::CartesianPose {
          time += period.toSec();
          if (time == 0.0) {
            initial_pose = robot_state.O_T_EE_c;
          }
          std::array<double, 16> new_pose = initial_pose;
          new_pose[12] += 0.005 * (1.0 - std::cos(M_PI * time / time_max));
          if (time >= time_max) {
            return franka::MotionFinished(new_pose);
          }
          return new_pose;
        });
  } catch (const franka::Exception& e) {
    std::cerr << e.what() << std::endl;
    return -1;
  }
  return 0;
}
