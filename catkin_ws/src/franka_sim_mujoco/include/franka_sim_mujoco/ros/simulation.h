// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/physics/world.h>
#include <franka_sim_mujoco/ros/clock_publisher.h>
#include <franka_sim_mujoco/ros/pacer.h>
#include <franka_sim_mujoco/ros/request_queue.h>
#include <franka_sim_mujoco/ros/robot_instance.h>

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace franka_sim_mujoco {

struct SimulationOptions {
  std::string world_file;        ///< MJCF; empty: the empty world
  double real_time_factor{1.0};  ///< see Pacer
  bool paused{false};
};

/// Where the simulation stands.
struct SimulationState {
  std::uint64_t tick{0};  ///< since the start; a reset does not set it back
  ros::Time time;
  std::uint64_t state_hash{0};  ///< World::stateHash
};

/// The world, the robots in it and the one thread that steps them: requests, then for each robot
/// readSim, controllers, writeSim, then the physics, then /clock.
///
/// ROS time begins at 1 ms and grows by 1 ms a tick; it never goes back, also not when the world is
/// reset. All public functions may be called from any thread and throw std::runtime_error with a
/// sentence.
class Simulation {
 public:
  /// Builds the world. @throws std::runtime_error what World throws, or for a wrong factor
  Simulation(const SimulationOptions& options, ros::NodeHandle& node);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  void start();
  /// Ends the stepping thread; requests are refused from now on.
  void stop();
  /// Whether a tick failed, which ended the simulation.
  bool failed() const noexcept { return failed_; }

  void setPaused(bool paused);
  void setRealTimeFactor(double factor);
  /// Advances a paused simulation without waiting for the pace and returns when that is done.
  SimulationState step(std::uint32_t ticks);
  SimulationState state();
  /// Everything to where it was first put; controllers are restarted.
  void reset();

  void spawn(const SpawnOrder& order);
  void remove(const std::string& robot);

  /// Runs work on the world in the stepping thread, between ticks.
  void withWorld(const std::function<void(World&)>& work);

  /// What each part of a tick takes of the stepping thread's computing time [us], over `ticks`
  /// ticks without waiting. Physics includes the publishing of /clock.
  struct Benchmark {
    double tick{0}, physics{0}, read{0}, update{0}, write{0}, bare{0};
  };
  Benchmark benchmark(std::uint32_t ticks);

 private:
  void loop();
  void tick(TickTimes* times);
  void standStill();
  void finishStepping();
  SimulationState stateNow() const;
  ros::Time time() const;
  RobotInstance* find(const std::string& name);

  RequestQueue requests_;
  HardwareLoader loader_;
  World world_;
  std::vector<std::unique_ptr<RobotInstance>> robots_;
  ClockPublisher clock_;
  Pacer pacer_;
  bool paused_;
  std::uint64_t tick_count_{0};
  std::uint32_t steps_left_{0};
  std::optional<std::promise<SimulationState>> stepped_;
  std::atomic<bool> stop_{false}, failed_{false};
  std::thread thread_;
};

}  // namespace franka_sim_mujoco
