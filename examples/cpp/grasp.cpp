// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/gripper.h>

#include <chrono>
#include <thread>

#include "common.h"

namespace {
constexpr char kDescription[] =
    "Homes the hand, opens it, grasps what is put between the fingers and lets it go.";
}  // namespace

int main(int argc, char** argv) {
  return example::run(argc, argv, kDescription, [](const std::string& address) {
    const franka::Gripper gripper(address);
    if (!gripper.homing()) {
      throw franka::CommandException("The homing has failed: is something between the fingers?");
    }
    const double widest = gripper.readOnce().max_width;
    gripper.move(widest, 0.1);
    std::printf("open %.4f; put something between the fingers within 3 s\n",
                gripper.readOnce().width);
    std::fflush(stdout);
    std::this_thread::sleep_for(std::chrono::seconds(3));
    // Anything from closed fingers to open ones counts as an object.
    const bool grasped = gripper.grasp(0.5 * widest, 0.05, 20, 0.5 * widest, 0.5 * widest);
    const franka::GripperState state = gripper.readOnce();
    std::printf("%s %.4f\n", grasped && state.is_grasped && state.width > 0.002 ? "holds" : "empty",
                state.width);
    gripper.stop();
    gripper.move(widest, 0.1);
    std::printf("released %.4f\n", gripper.readOnce().width);
  });
}
