// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/host.h>
#include <franka_sim/physics/world.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace franka_sim {

/// A window with the world, in its own thread. If it is closed, the simulation continues. As a
/// service of the host it copies the states of the robots' units, in the thread that runs them.
class Viewer final : public fci::Service {
 public:
  /// One line per robot for the user: its mode and errors.
  using Lines = std::function<std::vector<std::string>()>;

  /// Returns when the window is open.
  /// @param mutex is held while the world is stepped, and by the viewer while it copies the state
  /// or pushes a body.
  /// @param lines called by the host's thread
  /// @throws std::runtime_error if there is no display
  Viewer(World& world, std::mutex& mutex, Lines lines);
  ~Viewer() override;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void serve() override;
  void addDescriptors(std::vector<pollfd>&) const override {}

 private:
  void loop(std::promise<void> opened);
  std::vector<std::string> copyOfTexts();

  World& world_;
  std::mutex& mutex_;
  Lines lines_;
  std::chrono::steady_clock::time_point next_texts_;
  std::mutex texts_mutex_;
  std::vector<std::string> texts_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace franka_sim
