// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/glfw.h"

#include <stdexcept>

namespace franka_sim::physics {
namespace {

Glfw load() {
  try {
    return {};
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("The simulation's window cannot be opened (" +
                             std::string(error.what()) +
                             "); install the package libglfw3, or start without the window "
                             "(without --viewer; in ROS headless:=true).");
  }
}

}  // namespace

const Glfw& glfw() {
  static const Glfw functions = load();
  return functions;
}

}  // namespace franka_sim::physics
