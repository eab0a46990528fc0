// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace franka_control {

/// Sees to it that a node ends when it is told to (SIGINT, rosnode kill, ros::shutdown), whatever
/// its threads wait for: a robot that says nothing is waited for up to a minute, and libfranka
/// cannot be interrupted. What has not ended by itself in time ends with the process; the robot
/// then sees its connection closed, as it does when the cable is pulled.
///
/// The first object of a main(), so that it outlives all that may wait.
class EndInTime {
 public:
  /// @param node its name, for the sentence on standard error
  /// @param patience from the shutdown of ROS to the end of the process
  explicit EndInTime(std::string node,
                     std::chrono::milliseconds patience = std::chrono::milliseconds(1200));
  /// The node has ended by itself.
  ~EndInTime();
  EndInTime(const EndInTime&) = delete;
  EndInTime& operator=(const EndInTime&) = delete;

 private:
  void watch();
  /// @returns whether the node has ended within this time
  bool endedWithin(std::chrono::milliseconds time);

  const std::string node_;
  const std::chrono::milliseconds patience_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_{false};  // guarded by mutex_
  std::thread thread_;
};

}  // namespace franka_control
