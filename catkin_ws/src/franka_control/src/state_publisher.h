// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_msgs/FrankaState.h>
#include <realtime_tools/detail/publishing_thread.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

namespace franka_control {

/// Publishes states of a 1 kHz loop. Up to kWaiting states are queued while the publishing thread
/// does not run; later ones are lost.
///
/// The thread of the loop fills messages (`next`, `handOver`); the thread of all real-time
/// publishers of the process, or realtime_tools::publishPending(), sends them in the same order.
class StatePublisher : private realtime_tools::detail::PublishingThread::Sender {
 public:
  static constexpr std::size_t kWaiting = 64;

  /// @param period between two messages [s]: sets how many may wait for a subscriber's connection
  /// @throws ros::InvalidNameException if the topic's name is not valid.
  StatePublisher(const ros::NodeHandle& node, const std::string& topic, double period);
  /// Withdraws the topic; messages that were not sent are dropped.
  ~StatePublisher();
  StatePublisher(const StatePublisher&) = delete;
  StatePublisher& operator=(const StatePublisher&) = delete;

  /// The next message to fill, which still has old content, or null while too many messages wait.
  /// Real-time safe.
  franka_msgs::FrankaState* next() noexcept;
  /// Queues the message that `next` returned. Real-time safe.
  void handOver() noexcept;

 private:
  using Clock = realtime_tools::detail::PublishingSchedule::Clock;

  bool sendHandedOver(Clock::time_point& handed_over) override;

  ros::Publisher publisher_;
  std::vector<franka_msgs::FrankaState> ring_;
  std::atomic<std::size_t> handed_over_{0}, sent_{0};  ///< counts since the start
};

}  // namespace franka_control
