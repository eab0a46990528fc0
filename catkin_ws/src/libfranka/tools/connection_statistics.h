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

/// What the arrival of states says about a connection. A robot sends one each millisecond of its
/// clock: what of the time between two arrivals is not explained by that is jitter of the way.
class ConnectionStatistics {
 public:
  using Clock = std::chrono::steady_clock;

  /// A state arrived. @param robot_time of the state @param now when it was here
  void add(franka::Duration robot_time, Clock::time_point now);

  std::uint64_t received() const { return received_; }
  std::uint64_t lost() const { return lost_; }  ///< states that never came
  std::uint64_t mostLostInARow() const { return most_lost_; }
  /// Share of the states that came.
  double rate() const;
  /// Quantile of the lateness against the earliest state [ms]; 0 without states.
  double lateness(double quantile) const;
  /// How fast the robot's time runs against this machine's clock: 1 for a real robot, and for a
  /// simulated one that keeps real time. Compares the earliest states of both halves, so that
  /// jitter does not count; 1 where there are too few.
  double pace() const;
  /// Whether the robot's time is that of the clock, within 1 %. Otherwise it is a simulated one in
  /// lock-step or at another speed, and lateness says nothing.
  bool keepsTime() const;

 private:
  std::uint64_t received_{0}, lost_{0}, most_lost_{0};
  std::uint64_t last_time_{0};   // [ms] of the robot
  std::vector<double> times_;    // [ms] of the robot
  std::vector<double> offsets_;  // [ms] arrival minus robot time
};

}  // namespace franka_info
