// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "viewer.h"

#include <chrono>
#include <cstdio>
#include <exception>
#include <utility>

namespace franka_sim {

namespace {
constexpr std::chrono::milliseconds kFrame{33};
}  // namespace

Viewer::Viewer(World& world, Lines lines) : world_(world), lines_(std::move(lines)) {
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

void Viewer::serve() {
  const auto now = std::chrono::steady_clock::now();
  if (closed_ || now < next_view_) {
    return;
  }
  next_view_ = now + kFrame;
  std::optional<BodyPush> pull;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    pull = pull_;
  }
  push_.act(world_, pull);
  View view{captureScene(world_), lines_()};
  const std::lock_guard<std::mutex> lock(mutex_);
  view_ = std::move(view);
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
    std::optional<View> shown;
    while (open && !stop_) {
      const auto next = std::chrono::steady_clock::now() + kFrame;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (view_) {
          shown = std::exchange(view_, std::nullopt);
        }
        pull_ = window->push();
      }
      if (shown) {
        open = window->draw(shown->scene, shown->texts);
      }
      std::this_thread::sleep_until(next);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "franka_sim runs without its window: %s\n", error.what());
  }
  closed_ = true;
}

}  // namespace franka_sim
