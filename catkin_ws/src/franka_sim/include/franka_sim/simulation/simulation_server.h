// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/host.h>
#include <franka_sim/simulation/simulation.h>
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>

namespace franka_sim {

/// Puts robots of a simulation on the network, so that clients drive them while this process steps
/// the world. A tick waits for the answer of a client in motion; a robot moves either for a client
/// or for this process. Called by one thread, in place of the simulation's own step().
class SimulationServer {
 public:
  /// @param simulation outlives this
  /// @param pace kFreeRunning or kRealTime: whether ticks follow the clock
  SimulationServer(Simulation& simulation, const fci::Pace& pace);
  ~SimulationServer();
  SimulationServer(const SimulationServer&) = delete;
  SimulationServer& operator=(const SimulationServer&) = delete;

  /// Opens the interfaces of an arm and of its hand at an address of this machine, of which the
  /// robot becomes the only user. @throws std::runtime_error with a sentence
  void serve(SimulatedRobot& robot, const std::string& address);
  /// As Simulation::step. @throws std::runtime_error also in a process that was forked since
  void step(std::uint64_t ticks);
  /// Serves requests while time stands still, and shows clients that the robots are there. Does
  /// nothing shortly after a step. Call some fifty times a second.
  void attend();

 private:
  class Front;
  using Clock = std::chrono::steady_clock;

  const Front* front(const SimulatedRobot& robot) const;
  void advance();
  void checkProcess() const;

  Simulation& simulation_;
  std::deque<Front> fronts_;
  fci::Host host_;
  Clock::time_point stepped_at_{};
  pid_t process_;
};

}  // namespace franka_sim
