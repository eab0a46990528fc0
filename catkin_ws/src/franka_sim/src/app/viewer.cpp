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

Viewer::Viewer(World& world, std::mutex& mutex, Lines lines)
    : world_(world), mutex_(mutex), lines_(std::move(lines)) {
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
  if (now >= next_texts_) {
    next_texts_ = now + kFrame;
    std::vector<std::string> texts = lines_();
    const std::lock_guard<std::mutex> lock(texts_mutex_);
    texts_ = std::move(texts);
  }
}

std::vector<std::string> Viewer::copyOfTexts() {
  const std::lock_guard<std::mutex> lock(texts_mutex_);
  return texts_;
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
    PushByMouse push;
    while (open && !stop_) {
      const auto next = std::chrono::steady_clock::now() + kFrame;
      Scene scene;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        push.act(world_, window->push());
        scene = captureScene(world_);
      }
      open = window->draw(scene, copyOfTexts());
      std::this_thread::sleep_until(next);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "franka_sim runs without its window: %s\n", error.what());
  }
}

}  // namespace franka_sim
