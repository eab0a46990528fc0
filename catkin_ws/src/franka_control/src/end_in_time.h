// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace franka_control {

/// Ensures that a node ends after a shutdown of ROS (SIGINT, rosnode kill, ros::shutdown), even if
/// its threads wait: libfranka waits up to a minute for a silent robot and cannot be interrupted.
/// If the node has not ended by itself in time, the process is ended; the robot then detects a
/// closed connection, as if the cable were pulled.
///
/// Create it as the first object of main(), so that it outlives all objects that may wait.
class EndInTime {
 public:
  /// @param node its name, for the message on standard error
  explicit EndInTime(std::string node);
  /// Called when the node has ended by itself.
  ~EndInTime();
  EndInTime(const EndInTime&) = delete;
  EndInTime& operator=(const EndInTime&) = delete;

  /// Reads the parameter `shutdown_timeout`: the time from the shutdown of ROS to the end of the
  /// process [s]. @returns false, after logging the reason, if it is wrong
  bool readTimeout(const ros::NodeHandle& nh);

 private:
  void watch();
  /// @returns whether the node has ended within this time
  bool endedWithin(std::chrono::duration<double> time);

  const std::string node_;
  std::atomic<double> timeout_{1.2};  // [s], chosen here
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_{false};  // guarded by mutex_
  std::thread thread_;
};

}  // namespace franka_control
