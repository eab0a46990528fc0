// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Grasps an object, checks that it is still there, and releases it.
#include <franka/exception.h>
#include <franka/gripper.h>

#include <iostream>
#include <sstream>
#include <string>

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "Usage: " << argv[0] << " <gripper-hostname> <homing> <object-width>" << std::endl;
    return -1;
  }
  try {
    franka::Gripper gripper(argv[1]);
    const double grasping_width = std::stod(argv[3]);
    std::stringstream homing(argv[2]);
    bool should_home = false;
    homing >> should_home;
    if (should_home && !gripper.homing()) {
      std::cout << "Homing failed." << std::endl;
      return 1;
    }
    franka::GripperState gripper_state = gripper.readOnce();
    if (gripper_state.max_width < grasping_width) {
      std::cout << "Object is too large for the current fingers on the gripper." << std::endl;
      return 1;
    }
    if (!gripper.move(gripper_state.max_width, 0.1) || !gripper.grasp(grasping_width, 0.1, 60)) {
      std::cout << "Failed to grasp object." << std::endl;
      return 1;
    }
    gripper_state = gripper.readOnce();
    if (!gripper_state.is_grasped) {
      std::cout << "Object lost." << std::endl;
      return 1;
    }
    gripper.stop();
    std::cout << gripper_state << " of version " << gripper.serverVersion() << std::endl;
  } catch (const franka::Exception& e) {
    std::cerr << e.what() << std::endl;
    return -1;
  }
  return 0;
}
