// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/renderer.h>
#include <franka_sim/simulation/simulation_server.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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
      if (shared.closed_) {
        throw std::runtime_error("The simulation is closed.");
      }
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
  bool served() const noexcept { return server_ != nullptr; }
  /// Puts a robot on the network; the first call chooses the pace of all.
  void serve(const std::string& robot, const std::string& address,
             const franka_sim::fci::Pace& pace) {
    const Use use(*this);
    franka_sim::SimulatedRobot& served = simulation_.robot(robot);
    auto server =
        server_ ? nullptr : std::make_unique<franka_sim::SimulationServer>(simulation_, pace);
    (server ? *server : *server_).serve(served, address);
    if (server) {
      server_ = std::move(server);
    }
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
    }
  }

 private:
  franka_sim::Simulation simulation_;
  std::unique_ptr<franka_sim::SimulationServer> server_;
  std::unique_ptr<franka_sim::Renderer> renderer_;
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
  std::atomic<bool> closed_{false};
};

/// @throws std::invalid_argument for a negative number
inline std::uint64_t ticksOf(std::int64_t ticks) {
  if (ticks < 0) {
    throw std::invalid_argument("Time goes forwards only: " + std::to_string(ticks) + " ticks.");
  }
  return static_cast<std::uint64_t>(ticks);
}

}  // namespace pyfranka
