// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/simulation/simulation.h>

#include <cstddef>
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

}  // namespace franka_sim
