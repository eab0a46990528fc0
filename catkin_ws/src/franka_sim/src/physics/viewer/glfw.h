// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <GLFW/glfw3.h>

#include <stdexcept>
#include <string>

#include "physics/pictures/run_time_library.h"

namespace franka_sim::physics {

/// The functions of GLFW that the window needs. The library is loaded and not linked, because it
/// needs those of the X Window System: a simulation without a window runs on a machine without
/// them.
struct Glfw {
  RunTimeLibrary library{"libglfw.so.3"};
  decltype(&glfwInit) init = find<decltype(&glfwInit)>("glfwInit");
  decltype(&glfwTerminate) terminate = find<decltype(&glfwTerminate)>("glfwTerminate");
  decltype(&glfwCreateWindow) createWindow = find<decltype(&glfwCreateWindow)>("glfwCreateWindow");
  decltype(&glfwDestroyWindow) destroyWindow =
      find<decltype(&glfwDestroyWindow)>("glfwDestroyWindow");
  decltype(&glfwWindowShouldClose) windowShouldClose =
      find<decltype(&glfwWindowShouldClose)>("glfwWindowShouldClose");
  decltype(&glfwSetWindowUserPointer) setWindowUserPointer =
      find<decltype(&glfwSetWindowUserPointer)>("glfwSetWindowUserPointer");
  decltype(&glfwGetWindowUserPointer) getWindowUserPointer =
      find<decltype(&glfwGetWindowUserPointer)>("glfwGetWindowUserPointer");
  decltype(&glfwGetWindowSize) getWindowSize =
      find<decltype(&glfwGetWindowSize)>("glfwGetWindowSize");
  decltype(&glfwGetFramebufferSize) getFramebufferSize =
      find<decltype(&glfwGetFramebufferSize)>("glfwGetFramebufferSize");
  decltype(&glfwGetMouseButton) getMouseButton =
      find<decltype(&glfwGetMouseButton)>("glfwGetMouseButton");
  decltype(&glfwSetCursorPosCallback) setCursorPosCallback =
      find<decltype(&glfwSetCursorPosCallback)>("glfwSetCursorPosCallback");
  decltype(&glfwSetMouseButtonCallback) setMouseButtonCallback =
      find<decltype(&glfwSetMouseButtonCallback)>("glfwSetMouseButtonCallback");
  decltype(&glfwSetScrollCallback) setScrollCallback =
      find<decltype(&glfwSetScrollCallback)>("glfwSetScrollCallback");
  decltype(&glfwSetKeyCallback) setKeyCallback =
      find<decltype(&glfwSetKeyCallback)>("glfwSetKeyCallback");
  decltype(&glfwMakeContextCurrent) makeContextCurrent =
      find<decltype(&glfwMakeContextCurrent)>("glfwMakeContextCurrent");
  decltype(&glfwSwapInterval) swapInterval = find<decltype(&glfwSwapInterval)>("glfwSwapInterval");
  decltype(&glfwSwapBuffers) swapBuffers = find<decltype(&glfwSwapBuffers)>("glfwSwapBuffers");
  decltype(&glfwPollEvents) pollEvents = find<decltype(&glfwPollEvents)>("glfwPollEvents");

 private:
  template <typename Function>
  Function find(const char* name) const {
    return library.find<Function>(name);
  }
};

/// Loads the library at the first call. Thread-safe.
/// @throws std::runtime_error with the package to install if the machine does not have it
inline const Glfw& glfw() {
  static const Glfw functions = [] {
    try {
      return Glfw();
    } catch (const std::runtime_error& error) {
      throw std::runtime_error("The simulation's window cannot be opened (" +
                               std::string(error.what()) +
                               "); install the package libglfw3, or start without the window "
                               "(without --viewer; in ROS headless:=true).");
    }
  }();
  return functions;
}

}  // namespace franka_sim::physics
