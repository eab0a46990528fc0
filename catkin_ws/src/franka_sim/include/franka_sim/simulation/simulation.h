// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/simulation/simulated_robot.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim {

/// World and robots of a Simulation at a tick. Copies share it; it may outlive its simulation.
class SimulationSnapshot {
 private:
  friend class Simulation;
  struct Content;
  std::shared_ptr<const Content> content_;
};

/// A world with robots that one thread steps, without sockets, clocks and threads: the same inputs
/// give the same bits. After construction and after each function that changes the world, the
/// robots' states are those of the present moment.
class Simulation {
 public:
  /// A robot to put into the world.
  struct Robot {
    RobotSetup setup;  ///< arm_id is its name
    bool hand{true};   ///< false: none; that of a description of one's own is not driven
  };

  /// @param world MJCF or SDF file, or the name of one that is installed with franka_sim; empty: an
  /// empty world
  /// @throws std::exception with a sentence
  Simulation(const std::string& world, const std::vector<Robot>& robots);

  /// Advances by `ticks` milliseconds. @throws std::runtime_error once the physics has diverged
  void step(std::uint64_t ticks);
  /// The second half of a tick, after the robots have actuated: moves the world and observes.
  void advance() noexcept;
  /// Resets the world and the robots to their initial state.
  void reset();
  /// Saves the complete state of world and robots for restore(): what follows is the same to the
  /// last bit. @throws std::runtime_error if the physics has diverged
  SimulationSnapshot snapshot() const;
  /// Restores motions, commands, hands and settings too; robots that clients on the network use
  /// are idle instead. @param snapshot of this simulation, or of one with an equal world and equal
  /// robots @throws std::runtime_error if they differ; nothing has changed
  void restore(const SimulationSnapshot& snapshot);
  /// @throws std::invalid_argument for joint positions [rad] beyond the robot's limits
  static void checkPositions(const SimulatedRobot& robot, const std::array<double, 7>& q);
  /// Moves a robot to these joint positions [rad], at rest and without a motion.
  /// @throws std::invalid_argument as checkPositions
  void place(SimulatedRobot& robot, const std::array<double, 7>& q);

  /// The physics.
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
