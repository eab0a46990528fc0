// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns joint 1 within velocity limits that depend on the position and that the program itself
// applies.
#include <franka/control_types.h>
#include <franka/exception.h>
#include <franka/joint_velocity_limits.h>
#include <franka/rate_limiting.h>
#include <franka/robot.h>

#include <array>
#include <franka/commands/get_robot_model_command.hpp>
#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "Usage: " << argv[0] << " <robot-hostname>" << std::endl;
    return 2;
  }
  try {
    franka::Robot robot(argv[1], franka::RealtimeConfig::kIgnore);
    const std::array<double, 7> max_acceleration{{9, 9, 9, 9, 9, 9, 9}};
    const std::array<double, 7> max_jerk{{4000, 4000, 4000, 4000, 4000, 4000, 4000}};
    double time = 0.0;
    robot.control(
        [&](const franka::RobotState& state, franka::Duration period) -> franka::JointVelocities {
          time += period.toSec();
          const std::array<double, 7> desired{{time < 0.05 ? 0.2 : 0.0, 0, 0, 0, 0, 0, 0}};
          const franka::JointVelocities velocities(
              franka::limitRate(robot.getUpperJointVelocityLimits(state.q_d),
                                robot.getLowerJointVelocityLimits(state.q_d), max_acceleration,
                                max_jerk, desired, state.dq_d, state.ddq_d));
          return time < 0.1 ? velocities : franka::MotionFinished(velocities);
        },
        franka::ControllerMode::kJointImpedance, false, franka::kMaxCutoffFrequency);

    // The same limits without the robot: from the published table, and from its description.
    const std::array<double, 7> q{{0, 0, 0, -1.5, 0, 1.5, 0}};
    const std::array<double, 7> upper = franka::computeUpperLimitsJointVelocity(q);
    const std::array<double, 7> lower = franka::computeLowerLimitsJointVelocity(q);
    const franka::GetRobotModelResult model{robot.getRobotModel()};
    const franka::JointVelocityLimitsConfig limits(model.robot_model_urdf);
    for (std::size_t i = 0; i < 7; i++) {
      if (!(lower[i] < 0.0 && upper[i] > 0.0 && limits.getUpperJointVelocityLimits(q)[i] > 0.0 &&
            limits.getLowerJointVelocityLimits(q)[i] < 0.0)) {
        return 1;
      }
    }
  } catch (const franka::Exception& error) {
    std::cerr << error.what() << std::endl;
    return 1;
  }
  return 0;
}
