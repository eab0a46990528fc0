// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "window_view.h"

#include <franka_sim/physics/window.h>
#include <ros/console.h>

#include <chrono>
#include <exception>
#include <string>
#include <vector>

#include "service_handlers.h"
#include "simulation.h"

namespace franka_sim_mujoco {
namespace {

constexpr std::chrono::milliseconds kFrame{33};

}  // namespace

WindowView::WindowView(Simulation& simulation)
    : simulation_(simulation), thread_([this] { loop(); }) {}

WindowView::~WindowView() {
  stop_ = true;
  thread_.join();
}

void WindowView::loop() {
  try {
    franka_sim::Window window("franka_sim_mujoco");
    bool open = true;
    franka_sim::PushByMouse push;
    while (open && !stop_) {
      const auto next = std::chrono::steady_clock::now() + kFrame;
      franka_sim::Scene scene;
      std::vector<std::string> lines;
      simulation_.withWorld([&](franka_sim::World& world) {
        push.act(world, window.push());
        scene = franka_sim::captureScene(world);
        lines = simulation_.robots().conditions();
      });
      open = window.draw(scene, lines);
      std::this_thread::sleep_until(next);
    }
  } catch (const std::exception& error) {
    if (!stop_) {
      ROS_WARN_NAMED(kLog, "The simulation runs without its window: %s", error.what());
    }
  }
}

}  // namespace franka_sim_mujoco
