// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/simulation/observer.h>
#include <franka_sim/simulation/simulation.h>
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim {

/// Simulations that one call steps, on several threads. Each gives the same bits as one that is
/// stepped alone, whatever the number of threads. Calls from one thread at a time; the simulations
/// may be used as usual between calls.
class SimulationBatch {
 public:
  static constexpr int kMaxThreads = 1024;  ///< chosen here

  /// @param simulations of the same robots and world; they outlive the batch
  /// @param threads at most so many step at once, the caller's included; not more than the machine
  /// has cores
  /// @param observe what is read, as in Observer @throws std::invalid_argument
  SimulationBatch(std::vector<Simulation*> simulations, int threads,
                  const std::vector<std::string>& observe);
  ~SimulationBatch();
  SimulationBatch(const SimulationBatch&) = delete;
  SimulationBatch& operator=(const SimulationBatch&) = delete;

  /// Advances all by `ticks` milliseconds and observes them.
  /// @param keep_stepping is called now and then in the calling thread, and may end the step early
  /// @throws std::runtime_error once all others have been stepped, with the sentences of those
  /// whose physics has diverged; std::runtime_error in a process that was forked after construction
  void step(std::uint64_t ticks, const std::function<bool()>& keep_stepping = {});
  /// Observes the present state. @throws as step
  void observe();
  /// Puts another simulation in the place of one, and observes it. It outlives the batch, too.
  /// @throws std::invalid_argument if there is no such number, if the simulation is in the batch
  /// already, or if it does not have what is observed; nothing has changed
  void replace(std::size_t number, Simulation& simulation);

  /// One row a simulation. The address stays.
  const std::vector<double>& observations() const noexcept { return observations_; }
  /// @name How a row is divided
  /// @{
  std::size_t rowSize() const noexcept { return row_size_; }
  const std::vector<Observer::Value>& layout() const { return observers_.at(0).layout(); }
  /// @}

 private:
  class Threads;

  using Faults = std::vector<std::string>;  ///< a sentence each, or nothing

  /// Calls `function(i)` for each world without a fault, and adds those that it throws.
  template <typename Function>
  void forEach(Faults& faults, const Function& function);
  static void report(const Faults& faults);
  void advance(std::size_t number, std::uint64_t ticks);

  std::vector<Simulation*> simulations_;
  std::vector<Observer> observers_;
  std::size_t row_size_{0};
  std::vector<double> observations_;
  std::unique_ptr<Threads> threads_;
  pid_t process_;
};

}  // namespace franka_sim
