// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <atomic>
#include <future>
#include <mutex>
#include <thread>

namespace franka_sim {

/// A window with the world, in its own thread. If it is closed, the simulation continues.
class Viewer {
 public:
  /// Returns when the window is open.
  /// @param mutex is held while the world is stepped, and by the viewer while it copies the state.
  /// @throws std::runtime_error if there is no display
  Viewer(World& world, std::mutex& mutex);
  ~Viewer();
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

 private:
  void loop(std::promise<void> opened);

  World& world_;
  std::mutex& mutex_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace franka_sim
