// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/internal/controller_registry.h>
#include <controller_manager/internal/controller_watch.h>
#include <controller_manager/internal/loop_gate.h>
#include <controller_manager_msgs/ControllersStatistics.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/time.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace controller_manager {
namespace internal {

/// Reads the parameters `statistics_rate`, `abort_faulty_controllers`, `max_update_time` and
/// `default_switch_timeout` below `nh`.
/// @throws std::invalid_argument with a sentence, for a wrong type or a negative value.
Supervision readSupervision(const ros::NodeHandle& nh);

/// Runs the controllers' updates under supervision, and does the resulting work outside the loop:
/// handles faults, and publishes `statistics` (controller_manager_msgs/ControllersStatistics).
///
/// Each message covers the time since the one before, except the total count of overruns. max, mean
/// and variance_time refer to the execution of update(); variance_time holds the standard
/// deviation, because a variance [s^2] does not fit a duration. An overrun is an update that takes
/// longer than the cycle's period or than max_update_time. Two further entries describe the loop:
/// `control_loop` of type `execution`, for all controllers together, and of type `period`, whose
/// deviation is the jitter between cycles on the monotonic clock.
class Supervisor {
 public:
  /// Stops an aborted controller in the robot, and starts its fallbacks; false if it must be called
  /// again, then with `first` false.
  typedef std::function<bool(const std::string& name, bool first)> Settle;

  Supervisor(const Supervision& supervision, ControllerRegistry& registry, LoopGate& gate,
             const ros::NodeHandle& nh, Settle settle);
  ~Supervisor();

  /// One cycle, during a visit of the gate. Real-time safe.
  void update(const ControllerList& list, const ros::Time& time, const ros::Duration& period);

  /// Handles an aborted controller later; does not wait. Thread-safe.
  void handleLater(const std::string& name);

  const Supervision& supervision() const { return supervision_; }

 private:
  typedef std::chrono::steady_clock Clock;

  void run();
  void handleFaults();
  void publish();
  controller_manager_msgs::ControllerStatistics message(const std::string& name,
                                                        const std::string& type,
                                                        TimeStatistics& statistics);

  const Supervision supervision_;
  ControllerRegistry& registry_;
  LoopGate& gate_;
  const Settle settle_;
  ros::Publisher publisher_;
  std::map<std::string, std::pair<std::uint32_t, double>> overruns_;  ///< total, by entry

  std::atomic<std::size_t> window_{0};  ///< which statistics the loop writes
  TimeStatisticsPair execution_, cycle_;
  Clock::time_point last_cycle_{};

  std::mutex mutex_;
  std::condition_variable ending_;
  bool ended_{false};
  std::map<std::string, bool> unsettled_;  ///< aborted controllers; true before the first attempt
  std::thread thread_;
};

}  // namespace internal
}  // namespace controller_manager
