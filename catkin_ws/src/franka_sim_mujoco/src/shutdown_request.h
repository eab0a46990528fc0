// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace franka_sim_mujoco {

/// Asks the node to end, as SIGINT does. From any thread.
void requestShutdown();

/// Takes SIGINT and `rosnode kill` from roscpp, which shuts ROS down while services still create
/// controllers: whatever these advertise then is not valid, and code that was compiled with
/// assertions (libraries of Debian, actionlib) ends the process when it publishes there. The node
/// ends its own threads first, then ROS.
///
/// Create it in main() before the first object that advertises something, after ros::init. One at
/// a time.
class ShutdownRequest {
 public:
  /// @param patience from a request to a shutdown of ROS that does not wait for the node's end:
  /// callbacks of other people's code may wait for ros::ok() to become false. Chosen here: longer
  /// than the creation of a controller, shorter than roslaunch's 15 s until SIGTERM.
  explicit ShutdownRequest(std::chrono::milliseconds patience = std::chrono::seconds(5));
  ~ShutdownRequest();
  ShutdownRequest(const ShutdownRequest&) = delete;
  ShutdownRequest& operator=(const ShutdownRequest&) = delete;

  /// Returns after a request, or when ROS was shut down by others.
  void wait();

 private:
  const std::chrono::milliseconds patience_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_{false};  // guarded by mutex_
  std::thread limit_;
};

}  // namespace franka_sim_mujoco
