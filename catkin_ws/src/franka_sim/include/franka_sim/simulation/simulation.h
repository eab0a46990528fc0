// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/host.h>
#include <franka_sim/simulation/simulated_robot.h>
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
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
