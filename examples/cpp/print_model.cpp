// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>

#include "common.h"

namespace {
constexpr char kDescription[] =
    "Prints the model's results at the present state: frames, mass matrix, gravity. Moves "
    "nothing.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    franka::Robot robot(address, franka::RealtimeConfig::kIgnore);
    const franka::Model model = robot.loadModel();
    const franka::RobotState state = robot.readOnce();
    for (franka::Frame frame = franka::Frame::kJoint1; frame <= franka::Frame::kStiffness;
         frame++) {
      const std::array<double, 16> pose = model.pose(frame, state);
      std::printf("frame %d at %.4f %.4f %.4f\n", static_cast<int>(frame), pose[12], pose[13],
                  pose[14]);
    }
    const std::array<double, 49> mass = model.mass(state);
    std::printf("inertia of joint 1 %.4f\n", mass[0]);
    std::printf("gravity");
    for (const double torque : model.gravity(state)) {
      std::printf(" %.4f", torque);
    }
    std::printf("\n");
  });
}
