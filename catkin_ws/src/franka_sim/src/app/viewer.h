// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/window.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/serve/host.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace franka_sim {

/// A window with the world, in its own thread. If it is closed, the simulation continues. As a
/// service of the host it copies what the window shows, and pushes what the mouse pulls at, in the
/// thread that runs the world.
class Viewer final : public fci::Service {
 public:
  /// One line per robot for the user: its mode and errors.
  using Lines = std::function<std::vector<std::string>()>;

  /// Returns when the window is open.
  /// @param world, lines used by the host's thread
  /// @throws std::runtime_error if there is no display
  Viewer(World& world, Lines lines);
  ~Viewer() override;
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void serve() override;
  bool idle() const override { return closed_; }
  void addDescriptors(std::vector<pollfd>&) const override {}

 private:
  /// What a frame shows.
  struct View {
    Scene scene;
    std::vector<std::string> texts;
  };

  void loop(std::promise<void> opened);

  World& world_;
  Lines lines_;
  PushByMouse push_;
  std::chrono::steady_clock::time_point next_view_;
  std::mutex mutex_;          ///< of the next two
  std::optional<View> view_;  ///< not drawn yet
  std::optional<BodyPush> pull_;
  std::atomic<bool> stop_{false}, closed_{false};
  std::thread thread_;
};

}  // namespace franka_sim
