// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/serve/host.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <rosgraph_msgs/Clock.h>

#include <cstdint>
#include <memory>

namespace franka_sim_mujoco {

/// The lowest pace [simulated seconds per wall second]: a tick takes a tenth of a second, so that
/// requests are still served promptly.
constexpr double kMinPace = 0.01;

/// The host's pace for a real time factor; 0 means independent of the clock. Clients of robots in
/// motion are always waited for (docs/franka_sim.md).
/// @throws std::runtime_error with a sentence when it is not finite, negative, or slower than
/// kMinPace but not 0
franka_sim::fci::Pace paceOf(double real_time_factor);

/// Maximum rate of /clock in wall time [Hz] at a real time factor: one message per tick up to real
/// time; fewer beyond, where processors would do little else than wake up nodes.
double clockRateOf(double real_time_factor) noexcept;

/// Makes a thread that never waits sleep for a moment from time to time. Otherwise the kernel lets
/// other threads, above all of the same process, wait for seconds on a machine with other load.
/// Belongs to that thread; a thread that waits by itself is not delayed.
class ShortSleeps {
 public:
  /// Call often. Sleeps 1 ms if the thread has hardly slept for 20 ms: chosen here, it reduces the
  /// pace by a twentieth at most.
  void sleepIfDue() noexcept;

 private:
  std::int64_t looked_ns_{0};
  std::int64_t sleeps_{-1};  ///< of the thread, at the last check
};

/// The monotonic clock [ns].
std::int64_t monotonicNanoseconds() noexcept;

/// Computing time of the calling thread so far [ns]: for benchmarks, independent of other programs.
std::int64_t threadNanoseconds() noexcept;

/// Publishes /clock at a limited rate in wall time, however fast the simulation runs, because every
/// message wakes up every node. The time in each message is exact. Owned by the stepping thread.
class ClockPublisher {
 public:
  explicit ClockPublisher(ros::NodeHandle& node);

  /// @param rate maximum rate in wall time [Hz], above 0
  void setRate(double rate);

  /// Call after a tick. Neither locks nor allocates; skips a message while another is being sent.
  void tick(const ros::Time& time);
  /// Call while the simulation stands still: publishes the last time also for nodes that start
  /// later. At most ten messages a wall second unless the time is new. May wait for the network.
  void standStill(const ros::Time& time);

 private:
  realtime_tools::RealtimePublisher<rosgraph_msgs::Clock> publisher_;
  std::int64_t interval_ns_{1000000};
  std::int64_t next_ns_{0};
  ros::Time published_;
  std::int64_t published_ns_{0};
};

/// The pace of a simulation: applies the real time factor to its host, its world and /clock. While
/// robots start, time does not run faster than real time: the nodes that start their controllers
/// need the processors. Stepping thread only.
class SimulationPace {
 public:
  /// @param factor see paceOf
  /// @param clock_rate maximum rate of /clock in wall time [Hz]; 0: clockRateOf
  /// @param host, world, clock of the simulation; must outlive this
  /// @throws std::runtime_error with a sentence for a wrong factor or rate
  SimulationPace(double factor, double clock_rate, franka_sim::fci::Host& host,
                 franka_sim::World& world, ClockPublisher& clock);

  double factor() const noexcept { return factor_; }
  /// @throws std::runtime_error as paceOf
  void setFactor(double factor);
  /// Call between ticks. @param starting whether robots start
  void review(bool starting);

 private:
  void apply();

  franka_sim::fci::Host& host_;
  franka_sim::World& world_;
  ClockPublisher& clock_;
  double factor_;
  double clock_rate_;
  bool starting_{false};  ///< pace is limited now
};

}  // namespace franka_sim_mujoco
