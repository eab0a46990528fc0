// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <franka_sim/physics/window.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <optional>
#include <utility>

namespace franka_sim {

namespace {
constexpr std::chrono::milliseconds kFrame{33};
}  // namespace

Viewer::Viewer(World& world, std::mutex& mutex) : world_(world), mutex_(mutex) {
  std::promise<void> opened;
  std::future<void> open = opened.get_future();
  thread_ =
      std::thread([this, promise = std::move(opened)]() mutable { loop(std::move(promise)); });
  try {
    open.get();
  } catch (...) {
    thread_.join();
    throw;
  }
}

Viewer::~Viewer() {
  stop_ = true;
  thread_.join();
}

void Viewer::loop(std::promise<void> opened) {
  std::optional<Window> window;
  try {
    window.emplace("franka_sim");
  } catch (...) {
    opened.set_exception(std::current_exception());
    return;
  }
  opened.set_value();
  try {
    bool open = true;
    while (open && !stop_) {
      const auto next = std::chrono::steady_clock::now() + kFrame;
      Scene scene;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        scene = captureScene(world_);
      }
      open = window->draw(scene);
      std::this_thread::sleep_until(next);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "franka_sim runs without its window: %s\n", error.what());
  }
}

}  // namespace franka_sim
