// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <rosgraph_msgs/Clock.h>

#include <cstdint>
#include <memory>

namespace franka_sim_mujoco {

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

}  // namespace franka_sim_mujoco
