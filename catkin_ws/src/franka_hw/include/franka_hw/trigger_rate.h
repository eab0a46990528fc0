// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <ros/duration.h>
#include <ros/time.h>

namespace franka_hw {

/// A trigger with a fixed rate on ROS time.
///
/// Fires if at least one period has passed, and advances its stamp by whole periods: 1000 Hz in a
/// 1 kHz loop stay 1000 Hz, without a loss of phase (decision 24). If time jumps back, a new period
/// starts there. Called by one thread.
class TriggerRate {
 public:
  /// @param rate [Hz], above zero. @throws std::invalid_argument otherwise.
  /// Reads ros::Time::now(), so ROS time must be initialized.
  explicit TriggerRate(double rate = 30.0);

  /// @param start of the first period; ROS time need not be initialized.
  TriggerRate(double rate, const ros::Time& start);

  /// True if a period has passed since the last time it was true. Calls ros::Time::now(), which
  /// takes a lock under simulated time. Not real-time safe.
  bool operator()();

  /// The same with the time of the loop. Real-time safe.
  bool operator()(const ros::Time& now) noexcept;

 private:
  ros::Time time_stamp_;
  ros::Duration period_;
};

}  // namespace franka_hw
