// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/simulation/simulation.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace franka_sim {

/// Reads chosen values of a simulation into an array of numbers.
///
/// A value is `time` [s], `<robot>.<field>` or `<body>.pose` (x, y, z [m] and the quaternion w, x,
/// y, z, in the world) or `<body>.twist` (linear of its origin [m/s] and angular [rad/s], world
/// axes). Fields of a robot are arrays of franka_core::RobotState (matrices column by column),
/// `robot_mode` (the number of franka_core::RobotMode) and `width` between the fingers [m].
class Observer {
 public:
  /// A value, and how many numbers it has.
  struct Value {
    std::string name;  ///< as it is requested
    std::size_t size;  ///< count of numbers
  };

  /// @throws std::invalid_argument with a sentence for a value that is not known or named twice
  Observer(Simulation& simulation, const std::vector<std::string>& names);
  Observer(Observer&&) = default;
  Observer& operator=(Observer&&) = default;

  /// The default values: time; of each robot q, dq, O_T_EE, robot_mode and, with a hand, width; the
  /// pose of each object that moves.
  static std::vector<std::string> defaultNames(Simulation& simulation);

  /// In the order of the array.
  const std::vector<Value>& layout() const noexcept { return layout_; }
  /// Of the values, in the same order.
  std::vector<std::string> names() const;
  /// The number of values in the array.
  std::size_t size() const noexcept;
  /// Writes the present values. Allocates. @param values size() numbers
  void read(double* values) const;

 private:
  using Reader = void (*)(const SimulatedRobot&, double*);
  struct RobotValue {
    const SimulatedRobot* robot;
    Reader read;
    std::size_t at;
  };
  struct BodyValue {
    bool twist;
    std::size_t at;
  };

  void add(const std::string& name);
  bool addOfRobot(const std::string& owner, const std::string& field);

  Simulation* simulation_;
  std::vector<Value> layout_;
  std::vector<RobotValue> robots_;
  std::vector<BodyValue> bodies_;
  std::vector<std::string> body_names_;  ///< of each in bodies_
  std::vector<std::size_t> times_;       ///< where the time stands
};

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
