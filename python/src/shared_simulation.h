// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/renderer.h>
#include <franka_sim/simulation/simulation.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "arguments.h"

namespace pyfranka {

/// A simulation that one thread at a time may use.
class Shared {
 public:
  Shared(const std::string& world, const std::vector<franka_sim::Simulation::Robot>& robots)
      : simulation_(world, robots) {}

  /// Access for the duration of a call.
  class Use {
   public:
    explicit Use(Shared& shared) : busy_(shared.busy_) {
      shared.requireOpen();
      if (busy_.test_and_set()) {
        throw std::runtime_error(
            "Another thread uses this simulation now; give each thread one of its own.");
      }
    }
    ~Use() { busy_.clear(); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    std::atomic_flag& busy_;
  };

  franka_sim::Simulation& simulation() noexcept { return simulation_; }
  /// Calls a function with the simulation.
  template <typename Function>
  auto use(Function function) {
    const Use use(*this);
    return function(simulation_);
  }
  franka_sim::Picture render(const std::string& camera, int width, int height) {
    const Use use(*this);
    if (!renderer_) {
      renderer_ = std::make_unique<franka_sim::Renderer>();
    }
    const franka_sim::Scene scene = franka_sim::captureScene(simulation_.world());
    return camera.empty() ? renderer_->render(scene, franka_sim::Camera{}, width, height)
                          : renderer_->render(scene, camera, width, height);
  }
  bool closed() const noexcept { return closed_; }
  /// @throws std::runtime_error once it is closed
  void requireOpen() const {
    if (closed_) {
      throw std::runtime_error("The simulation is closed.");
    }
  }
  bool served() const noexcept { return server_ != nullptr; }
  /// Puts a robot on the network; the first call chooses the pace of all robots, and the callback
  /// that ends a wait.
  void serve(const std::string& robot, const std::string& address,
             const franka_sim::fci::Pace& pace, std::function<bool()> keep_waiting) {
    const Use use(*this);
    franka_sim::SimulatedRobot& served = simulation_.robot(robot);
    auto server = server_ ? nullptr
                          : std::make_unique<franka_sim::SimulationServer>(
                                simulation_, pace,
                                franka_sim::SimulationServer::Hooks{
                                    [this](const std::string& what) { keepEvent(what); },
                                    std::move(keep_waiting)});
    (server ? *server : *server_).serve(served, address);
    if (server) {
      server_ = std::move(server);
    }
  }
  /// Reports of the served robots since the last call: collisions, refused clients.
  std::vector<std::string> takeEvents() {
    const std::lock_guard lock(events_mutex_);
    return std::exchange(events_, {});
  }
  /// Call with a Use.
  void step(std::uint64_t ticks) {
    if (server_) {
      server_->step(ticks);
    } else {
      simulation_.step(ticks);
    }
  }
  /// Serves clients while the program does not step. @returns false once it is closed
  bool attend() {
    if (!closed_ && server_ && !busy_.test_and_set()) {
      server_->attend();
      busy_.clear();
    }
    return !closed_;
  }
  /// Clients lose their robots.
  void close() {
    if (!closed_) {
      const Use use(*this);
      closed_ = true;
      server_.reset();
      renderer_.reset();
    }
  }

 private:
  void keepEvent(const std::string& what) {
    constexpr std::size_t kMaxEvents =
        100;  // chosen here; the caller fetches them 50 times per second
    const std::lock_guard lock(events_mutex_);
    if (events_.size() < kMaxEvents) {
      events_.push_back(what);
    }
  }

  franka_sim::Simulation simulation_;
  std::mutex events_mutex_;
  std::vector<std::string> events_;
  std::unique_ptr<franka_sim::SimulationServer> server_;
  std::unique_ptr<franka_sim::Renderer> renderer_;
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
  std::atomic<bool> closed_{false};
};

/// @throws as wholeNumber, and std::invalid_argument for a negative number
inline std::uint64_t ticksOf(const py::object& value) {
  const std::int64_t ticks = wholeNumber(value, "ticks");
  if (ticks < 0) {
    throw std::invalid_argument("Time goes forwards only: " + std::to_string(ticks) + " ticks.");
  }
  return static_cast<std::uint64_t>(ticks);
}

}  // namespace pyfranka
