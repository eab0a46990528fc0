// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Moves one joint slightly and back: the robot's settings, joint positions, the log of an abort.
#include <franka/exception.h>
#include <franka/robot.h>

#include <cmath>
#include <fstream>
#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "Usage: " << argv[0] << " <robot-hostname>" << std::endl;
    return -1;
  }
  try {
    franka::Robot robot(argv[1], franka::RealtimeConfig::kIgnore);
    robot.automaticErrorRecovery();
    robot.setCollisionBehavior(
        {{20.0, 20.0, 18.0, 18.0, 16.0, 14.0, 12.0}}, {{20.0, 20.0, 18.0, 18.0, 16.0, 14.0, 12.0}},
        {{20.0, 20.0, 18.0, 18.0, 16.0, 14.0, 12.0}}, {{20.0, 20.0, 18.0, 18.0, 16.0, 14.0, 12.0}},
        {{20.0, 20.0, 20.0, 25.0, 25.0, 25.0}}, {{20.0, 20.0, 20.0, 25.0, 25.0, 25.0}},
        {{20.0, 20.0, 20.0, 25.0, 25.0, 25.0}}, {{20.0, 20.0, 20.0, 25.0, 25.0, 25.0}});
    robot.setJointImpedance({{3000, 3000, 3000, 2500, 2500, 2000, 2000}});
    robot.setCartesianImpedance({{3000, 3000, 3000, 300, 300, 300}});

    std::array<double, 7> initial_position;
    double time = 0.0;
    robot.control([&initial_position, &time](const franka::RobotState& robot_state,
                                             franka::Duration period) -> franka::JointPositions {
      time += period.toSec();
      if (time == 0.0) {
        initial_position = robot_state.q_d;
      }
      const double delta_angle = 0.05 * (1.0 - std::cos(2.0 * M_PI * time));
      franka::JointPositions output = initial_position;
      output.q[3] += delta_angle;
      if (time >= 1.0) {
        return franka::MotionFinished(output);
      }
      return output;
    });
    std::cout << "finished after " << time << " s" << std::endl;
  } catch (const franka::ControlException& e) {
    std::ofstream("/dev/null") << franka::logToCSV(e.log);
    std::cerr << e.what() << std::endl;
    return -1;
  } catch (const franka::Exception& e) {
    std::cerr << e.what() << std::endl;
    return -1;
  }
  return 0;
}
