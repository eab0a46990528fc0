// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>

namespace franka_sim_mujoco {

class Simulation;

/// Shows the simulation in a window, thirty times a second, from its own thread: the stepping
/// thread only copies the scene. Without a display it logs so and does nothing; if the user closes
/// the window, the simulation continues.
class WindowView {
 public:
  explicit WindowView(Simulation& simulation);
  ~WindowView();
  WindowView(const WindowView&) = delete;
  WindowView& operator=(const WindowView&) = delete;

 private:
  void loop();

  Simulation& simulation_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace franka_sim_mujoco
