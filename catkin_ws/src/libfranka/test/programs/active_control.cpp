// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Torques without callbacks, and the state as JSON.
#include <franka/active_control.h>
#include <franka/active_torque_control.h>
#include <franka/exception.h>
#include <franka/robot.h>

#include <iostream>
#include <memory>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "Usage: " << argv[0] << " <robot-hostname>" << std::endl;
    return -1;
  }
  try {
    franka::Robot robot(argv[1], franka::RealtimeConfig::kIgnore);
    size_t count = 0;
    robot.read([&count](const franka::RobotState& robot_state) {
      std::cout << robot_state << std::endl;
      return count++ < 10;
    });
    std::unique_ptr<franka::ActiveControlBase> active_control = robot.startTorqueControl();
    double time = 0.0;
    bool motion_finished = false;
    while (!motion_finished) {
      const auto read_once_return = active_control->readOnce();
      const franka::RobotState robot_state = read_once_return.first;
      const franka::Duration duration = read_once_return.second;
      time += duration.toSec();
      franka::Torques torques{robot_state.tau_J_d};
      if (time >= 0.2) {
        torques.motion_finished = true;
        motion_finished = true;
      }
      active_control->writeOnce(torques);
    }
    auto position_control = robot.startJointPositionControl(
        research_interface::robot::Move::ControllerMode::kJointImpedance);
    const franka::RobotState state = position_control->readOnce().first;
    position_control->writeOnce(franka::MotionFinished(franka::JointPositions(state.q_d)));
  } catch (const franka::Exception& e) {
    std::cerr << e.what() << std::endl;
    return -1;
  }
  return 0;
}
