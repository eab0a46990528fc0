// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/simulation/simulated_robot.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace franka_sim {

/// A world with robots that one thread steps, without sockets, clocks and threads: the same inputs
/// give the same bits. After construction and after each function that changes the world, the
/// robots' states are those of the present moment.
class Simulation {
 public:
  struct Robot {
    RobotSetup setup;  ///< arm_id is its name
    bool hand{true};
  };

  /// @param world MJCF or SDF file, or the name of one that comes along; empty: an empty world
  /// @throws std::exception with a sentence
  Simulation(const std::string& world, const std::vector<Robot>& robots);

  /// Advances by `ticks` milliseconds. @throws std::runtime_error once the physics has diverged
  void step(std::uint64_t ticks);
  /// The second half of a tick, after the robots have actuated: moves the world and observes.
  void advance() noexcept;
  /// Resets the world and the robots to how they began.
  void reset();
  /// Restores a snapshot of the world; the robots hold their poses in it, without a motion.
  void restore(const Snapshot& snapshot);
  /// @throws std::invalid_argument for joint positions [rad] beyond the robot's limits
  static void checkPositions(const SimulatedRobot& robot, const std::array<double, 7>& q);
  /// Moves a robot to these joint positions [rad], at rest and without a motion.
  /// @throws std::invalid_argument as checkPositions
  void place(SimulatedRobot& robot, const std::array<double, 7>& q);

  World& world() noexcept { return world_; }
  /// In the order of construction; addresses stay.
  std::deque<SimulatedRobot>& robots() noexcept { return robots_; }
  /// @throws std::out_of_range with a sentence that names those that exist
  SimulatedRobot& robot(const std::string& name);

 private:
  void restartRobots();

  World world_;
  std::deque<SimulatedRobot> robots_;
};

}  // namespace franka_sim
