// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/serve/host.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pace.h"
#include "request_queue.h"
#include "robot_set.h"

namespace franka_sim_mujoco {

struct SimulationOptions {
  std::string world_file;        ///< MJCF or SDF; empty: the empty world
  double real_time_factor{1.0};  ///< see paceOf
  double clock_rate{0.0};        ///< maximum rate of /clock in wall time [Hz]; 0: clockRateOf
  bool paused{false};
};

/// Content of the world, and its settings.
struct SimulationInventory {
  std::vector<std::string> robots, objects, bodies, joints, cameras;
  std::array<double, 3> gravity{};
  bool paused{false};
  double real_time_factor{1};
};

/// Progress of the simulation.
struct SimulationState {
  std::uint64_t tick{0};  ///< since the start; a reset does not change it
  ros::Time time;
  std::uint64_t state_hash{0};  ///< World::stateHash
};

/// The world, its robots and the one thread that steps them. A cycle serves requests; then the host
/// keeps the pace and serves clients of served robots; then each other robot runs readSim,
/// controllers, writeSim; then physics, then /clock.
///
/// ROS time starts at 1 ms and grows by 1 ms per tick; it never goes back, not even when the world
/// is reset. All public functions throw std::runtime_error with a sentence. Thread-safe.
class Simulation {
 public:
  /// Builds the world. @throws std::runtime_error as World, or for a wrong factor
  Simulation(const SimulationOptions& options, ros::NodeHandle& node);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  void start();
  /// Ends the stepping thread; later requests are refused.
  void stop();
  /// Whether the simulation ended because a tick failed.
  bool failed() const noexcept { return failed_; }

  void setPaused(bool paused);
  void setRealTimeFactor(double factor);
  /// Advances a paused simulation without waiting for the pace and returns when done. setPaused()
  /// and stop() end it before. @param ticks at most kMaxSteps
  SimulationState step(std::uint32_t ticks);
  static constexpr std::uint32_t kMaxSteps = 3600000;  ///< an hour (chosen here)
  SimulationState state();
  /// Resets everything to its initial state; controllers are restarted. A world that has stopped
  /// (World::stopped) runs again.
  void reset();

  /// Adds and removes robots and objects.
  RobotSet& robots() noexcept { return robots_; }
  SimulationInventory inventory();

  /// Stores the world's state under a name (at most kMaxSnapshots). @returns its hash
  std::uint64_t takeSnapshot(const std::string& name);
  /// Restores the world; control units and controllers restart. @returns its hash
  std::uint64_t restoreSnapshot(const std::string& name);
  static constexpr std::size_t kMaxSnapshots = 32;

  /// Runs work on the world in the stepping thread, between ticks. The work may also call functions
  /// of robots() that are for that thread.
  void withWorld(const std::function<void(franka_sim::World&)>& work);

  /// Computing time of the stepping thread for a tick and for each of its parts [us]. Makes `ticks`
  /// ticks without waiting for the whole, and as many again for the parts. Physics includes the
  /// publishing of /clock. Requests wait meanwhile; setPaused() and stop() end it.
  /// @param ticks at most kMaxBenchmarkTicks
  struct Benchmark {
    double tick{0}, physics{0}, read{0}, update{0}, write{0}, bare{0};
  };
  Benchmark benchmark(std::uint32_t ticks);
  static constexpr std::uint32_t kMaxBenchmarkTicks = 1000000;  ///< minutes (chosen here)

 private:
  using Clock = std::chrono::steady_clock;

  void loop();
  void advance();
  Benchmark measure(std::uint32_t ticks);
  /// Makes ticks without waiting. @returns the mean computing time of one [us]
  /// @throws std::runtime_error when the benchmark has to end
  double timeTicks(std::uint32_t ticks);
  double timeBareTicks(std::uint32_t ticks);  ///< the same for bareTickMicroseconds()
  /// @throws std::runtime_error if stop() or setPaused() was called since the benchmark began
  void requireUncancelled() const;
  void finishStepping(std::exception_ptr error);
  void standStill();
  /// While a robot or object comes or goes.
  void holdTime();
  void finishStepping();
  /// The state of the world is published with its present time.
  void publishNow();
  /// Reports faults of the world; one that has stopped pauses the simulation.
  void watchWorld();
  /// @throws std::runtime_error with a sentence if the world has stopped
  void requireRunningWorld() const;
  /// Call after the world was reset or restored.
  void worldWasReset();
  SimulationState stateNow() const;
  ros::Time time() const;

  RequestQueue requests_;
  franka_sim::World world_;
  std::map<std::string, franka_sim::Snapshot> snapshots_;
  ClockPublisher clock_;
  franka_sim::fci::Host host_;
  SimulationPace pace_;
  RobotSet robots_;
  ShortSleeps short_sleeps_;
  TickTimes times_;
  bool timing_{false};
  bool paused_;
  bool paused_by_fault_{false};  ///< the world has stopped
  std::uint64_t tick_count_{0};
  std::uint32_t steps_left_{0};
  std::optional<Clock::time_point> shown_at_;  ///< to clients, while time is held
  std::atomic<std::uint64_t> cancels_{0};      ///< calls of setPaused
  std::uint64_t benchmark_cancels_{0};         ///< the same at the begin of the benchmark
  std::optional<std::promise<SimulationState>> stepped_;
  std::atomic<bool> stop_{false}, failed_{false};
  std::thread thread_;
};

}  // namespace franka_sim_mujoco
