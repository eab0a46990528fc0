// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <thread>

namespace franka_sim_mujoco {

class Simulation;

/// Shows the simulation in a window, thirty times a second, from a thread of its own: the stepping
/// thread only copies the moment. Without a display it says so and does nothing; the user may close
/// the window, the simulation goes on.
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
