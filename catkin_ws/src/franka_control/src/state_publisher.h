// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_msgs/FrankaState.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <thread>
#include <vector>

namespace franka_control {

/// Publishes states of a 1 kHz loop. kWaiting of them may wait for a machine that does not let the
/// publishing thread run; later ones are lost then.
///
/// One thread fills messages (`next`, `handOver`: no allocation, lock or system call), a thread of
/// its own sends them in the same order.
class StatePublisher {
 public:
  static constexpr std::size_t kWaiting = 64;

  /// @param period between two messages [s]: how often the thread looks for them, and how many may
  /// wait for a subscriber's connection
  /// @throws ros::InvalidNameException if the topic's name is not valid.
  StatePublisher(const ros::NodeHandle& node, const std::string& topic, double period);
  /// Withdraws the topic; what was not sent is dropped.
  ~StatePublisher();
  StatePublisher(const StatePublisher&) = delete;
  StatePublisher& operator=(const StatePublisher&) = delete;

  /// The message to be filled, with whatever it held once, or null while too many wait.
  franka_msgs::FrankaState* next() noexcept;
  /// Has the message sent that `next` gave.
  void handOver() noexcept;

 private:
  void run();

  ros::Publisher publisher_;
  std::chrono::duration<double> pause_;  ///< between looks
  std::vector<franka_msgs::FrankaState> ring_;
  std::atomic<std::size_t> handed_over_{0}, sent_{0};  ///< how many, ever
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace franka_control
