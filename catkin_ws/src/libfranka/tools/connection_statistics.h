// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>

#include <chrono>
#include <cstdint>
#include <vector>

namespace franka_info {

/// Quantile (0 to 1) of some values; 0 without any.
double quantileOf(std::vector<double> values, double quantile);

/// Quality of a connection from the arrival of states. A robot sends one per millisecond of its
/// clock; further variation between arrivals is jitter of the network.
class ConnectionStatistics {
 public:
  using Clock = std::chrono::steady_clock;

  /// Adds a received state. @param robot_time of the state @param now time of arrival
  void add(franka::Duration robot_time, Clock::time_point now);

  std::uint64_t received() const { return received_; }
  std::uint64_t lost() const { return lost_; }  ///< states that never arrived
  std::uint64_t mostLostInARow() const { return most_lost_; }
  /// Share of received states.
  double rate() const;
  /// Quantile of the lateness against the earliest state [ms]; 0 without states.
  double lateness(double quantile) const;
  /// Speed of the robot's time relative to this machine's clock: 1 for a real robot, and for a
  /// simulated one in real time. Compares the earliest states of both halves, so that jitter does
  /// not count; 1 if there are too few.
  double pace() const;
  /// Whether the robot's time follows the clock within 1 %. Otherwise it is a simulated one in
  /// lock-step or at another speed, and lateness has no meaning.
  bool keepsTime() const;

 private:
  std::uint64_t received_{0}, lost_{0}, most_lost_{0};
  std::uint64_t last_time_{0};   // [ms] of the robot
  std::vector<double> times_;    // [ms] of the robot
  std::vector<double> offsets_;  // [ms] arrival minus robot time
};

}  // namespace franka_info
