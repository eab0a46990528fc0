// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace franka_info {

/// Repeats a request that changes nothing, from its own thread, and measures the time until the
/// reply over the TCP command channel.
///
/// The request is for a virtual wall (protocol 3 to 5) or the robot's description (8 to 10).
/// Between these versions no such request exists; a robot in Idle then gets its own stiffness frame
/// again, bit for bit. A refusal counts as a reply.
class RoundTrips {
 public:
  /// Starts. @param state of the robot now
  RoundTrips(franka::Robot& robot, const franka::RobotState& state);
  ~RoundTrips();
  RoundTrips(const RoundTrips&) = delete;
  RoundTrips& operator=(const RoundTrips&) = delete;

  /// Waits for the pending reply. Call it before the functions below.
  void stop();
  /// Name of the command.
  const char* command() const { return command_; }
  /// Times of all round trips [ms].
  const std::vector<double>& times() const { return times_; }
  /// Why measuring stopped; empty otherwise.
  const std::string& error() const { return error_; }

 private:
  void choose(const franka::RobotState& state);
  void repeat();
  bool isToStop();

  franka::Robot& robot_;
  const char* command_{""};
  std::function<void()> ask_;
  std::vector<double> times_;
  std::string error_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_{false};
  std::thread thread_;
};

}  // namespace franka_info
