// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/host.h>
#include <franka_sim/simulation/simulation.h>
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <string>

namespace franka_sim {

/// Puts robots of a simulation on the network, so that clients drive them while this process steps
/// the world. A tick waits for the answer of a client in motion; a robot moves either for a client
/// or for this process. Called by one thread, in place of the simulation's own step().
class SimulationServer {
 public:
  /// Callbacks; each may be empty.
  struct Hooks {
    /// Reports a collision, or why a connection was ended: a sentence. Within step() and attend().
    std::function<void(const std::string&)> report;
    /// Called about 20 times per second while a tick waits for a client. If it returns false, that
    /// tick proceeds without the client's answer and is the last one of step().
    std::function<bool()> keep_waiting;
  };

  /// @param simulation outlives this
  /// @param pace kFreeRunning or kRealTime: whether ticks follow the clock
  SimulationServer(Simulation& simulation, const fci::Pace& pace, Hooks hooks = {});
  ~SimulationServer();
  SimulationServer(const SimulationServer&) = delete;
  SimulationServer& operator=(const SimulationServer&) = delete;

  /// Opens the interfaces of an arm and of its hand at an address of this machine, of which the
  /// robot becomes the only user. @throws std::runtime_error with a sentence
  void serve(SimulatedRobot& robot, const std::string& address);
  /// As Simulation::step; ends early after Hooks::keep_waiting has returned false.
  /// @throws std::runtime_error also in a process that was forked since
  void step(std::uint64_t ticks);
  /// Serves requests while time stands still, and shows clients that the robots are there. Does
  /// nothing shortly after a step. Call about 50 times per second.
  void attend();

 private:
  class Front;
  using Clock = std::chrono::steady_clock;

  const Front* front(const SimulatedRobot& robot) const;
  void advance();
  void checkProcess() const;

  Simulation& simulation_;
  Hooks hooks_;
  std::deque<Front> fronts_;
  fci::Host host_;
  Clock::time_point stepped_at_{};
  bool interrupted_{false};
  pid_t process_;
};

}  // namespace franka_sim
