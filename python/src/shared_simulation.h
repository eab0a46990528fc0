// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/renderer.h>
#include <franka_sim/physics/scene.h>
#include <franka_sim/simulation/simulation.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
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
    explicit Use(Shared& shared) : shared_(shared) {
      shared.requireOpen();
      if (!shared.acquire()) {
        throw std::runtime_error(
            "Another thread uses this simulation now; give each thread one of its own.");
      }
      if (shared.closed()) {  // by another thread, since it was open
        shared.release();
        shared.requireOpen();
      }
    }
    ~Use() { shared_.release(); }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

   private:
    Shared& shared_;
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
  /// @throws std::runtime_error if it has been closed within the present use
  void requireStepped() const {
    if (closed_) {
      throw std::runtime_error("The simulation was closed while it stepped.");
    }
  }
  bool served() const noexcept { return server_ != nullptr; }
  /// Puts a robot on the network; the first call chooses the pace of all robots, and the callback
  /// that ends a wait.
  void serve(const std::string& robot, const std::string& address,
             const franka_sim::fci::Pace& pace, std::function<bool()> keep_waiting) {
    const Use use(*this);
    franka_sim::SimulatedRobot& served = simulation_.robot(robot);
    const auto keep_stepping = [this, keep_waiting = std::move(keep_waiting)] {
      interrupted_ = closed_ || !keep_waiting();
      return !interrupted_;
    };
    auto server =
        server_ ? nullptr
                : std::make_unique<franka_sim::SimulationServer>(
                      simulation_, pace,
                      franka_sim::SimulationServer::Hooks{
                          [this](const std::string& what) { keepEvent(what); }, keep_stepping});
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
  /// Ends early once the simulation is closed or a wait for a client was ended. Call with a Use.
  void step(std::uint64_t ticks) {
    interrupted_ = false;
    for (std::uint64_t tick = 0; tick < ticks && !closed_ && !interrupted_; tick++) {
      if (server_) {
        server_->step(1);
      } else {
        simulation_.step(1);
      }
    }
  }
  /// Serves clients while the program does not step. @returns false once it is closed
  bool attend() {
    if (!closed_ && acquire()) {
      if (server_) {
        server_->attend();
      }
      release();
    }
    return !closed_;
  }
  /// Clients lose their robots. A use of this thread, which then runs a signal's handler or the
  /// like, and one of another thread end soon.
  /// @returns false while another thread uses it: call again
  bool close() {
    closed_ = true;
    if (user_ == std::this_thread::get_id()) {
      return true;  // what is served ends with that use
    }
    if (!acquire()) {
      return user_process_ != getpid();  // before a fork: its thread does not exist here
    }
    release();
    return true;
  }

 private:
  /// @returns false if it is in use
  bool acquire() noexcept {
    std::thread::id nobody;
    const bool acquired = user_.compare_exchange_strong(nobody, std::this_thread::get_id());
    if (acquired) {
      user_process_ = getpid();
    }
    return acquired;
  }
  void release() {
    if (closed_) {
      server_.reset();
      renderer_.reset();
    }
    user_ = std::thread::id();
  }
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
  std::atomic<std::thread::id> user_{};  ///< none: nobody uses it
  std::atomic<pid_t> user_process_{0};
  std::atomic<bool> closed_{false};
  std::atomic<bool> interrupted_{false};  ///< a wait for a client, in the present step
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
