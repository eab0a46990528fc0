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

/// Asks a robot again and again, from a thread of its own, for something that changes nothing, and
/// takes the time until the answer: that of the command channel, over TCP.
///
/// Asked for is a virtual wall (protocol 3 to 5) or the robot's description (8 to 10). Between
/// these versions there is no question; a robot in Idle is told to keep the stiffness frame that it
/// has, bit for bit. An answer counts also where it is a refusal.
class RoundTrips {
 public:
  /// Begins. @param state of the robot now
  RoundTrips(franka::Robot& robot, const franka::RobotState& state);
  ~RoundTrips();
  RoundTrips(const RoundTrips&) = delete;
  RoundTrips& operator=(const RoundTrips&) = delete;

  /// Waits for the answer under way. After this the others may be called.
  void stop();
  /// Name of the command.
  const char* command() const { return command_; }
  /// Of each round trip [ms].
  const std::vector<double>& times() const { return times_; }
  /// Why no more could be measured; empty otherwise.
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
