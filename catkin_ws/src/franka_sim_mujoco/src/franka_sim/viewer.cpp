// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <franka_sim_mujoco/physics/window.h>

#include <chrono>
#include <cstdio>
#include <exception>

namespace franka_sim_mujoco {

namespace {
constexpr std::chrono::milliseconds kFrame{33};
}  // namespace

Viewer::Viewer(World& world, std::mutex& mutex)
    : world_(world), mutex_(mutex), thread_([this] { loop(); }) {}

Viewer::~Viewer() {
  stop_ = true;
  thread_.join();
}

void Viewer::loop() {
  try {
    Window window("franka_sim");
    bool open = true;
    while (open && !stop_) {
      const auto next = std::chrono::steady_clock::now() + kFrame;
      Scene scene;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        scene = captureScene(world_);
      }
      open = window.draw(scene);
      std::this_thread::sleep_until(next);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "franka_sim runs without its window: %s\n", error.what());
  }
}

}  // namespace franka_sim_mujoco
