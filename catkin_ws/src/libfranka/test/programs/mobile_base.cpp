// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Prints the positions of a mobile base's drive modules, or that the robot is an arm.
#include <franka/exception.h>
#include <franka/mobile_model.h>
#include <franka/model.h>
#include <franka/robot.h>

#include <array>
#include <iostream>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "Usage: " << argv[0] << " <robot-hostname>" << std::endl;
    return 2;
  }
  try {
    franka::Robot robot(argv[1], franka::RealtimeConfig::kIgnore);
    const std::string urdf = robot.getRobotModel();
    if (!robot.isMobileRobot()) {
      const franka::Model arm(urdf);
      std::cout << "an arm; its flange is "
                << arm.pose(franka::Frame::kFlange, robot.readOnce())[14] << " m above its base"
                << std::endl;
    }
    const franka::MobileModel base(urdf);
    const franka::MobileJointPositions straight{};
    for (auto frame : {franka::MobileFrame::kDriveModule1, franka::MobileFrame::kDriveModule2}) {
      const std::array<double, 16> pose = base.pose(frame, straight);
      std::cout << pose[12] << " " << pose[13] << std::endl;
    }
  } catch (const franka::Exception& error) {
    std::cout << error.what() << std::endl;
    return 1;
  }
  return 0;
}
