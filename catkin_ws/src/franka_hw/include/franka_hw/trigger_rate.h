// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <ros/duration.h>
#include <ros/time.h>

namespace franka_hw {

/// Says when a periodic thing is due, on ROS time.
///
/// Fires when at least one period has passed and advances its stamp by whole periods: 1000 Hz in a
/// 1 kHz loop stay 1000 Hz, without a loss of phase (decision 24). Time that jumps back starts a
/// new period there. Not thread-safe. With an explicit time real-time safe; without one as
/// real-time safe as ros::Time::now(), which takes a lock under simulated time.
class TriggerRate {
 public:
  /// @param rate [Hz], above zero. @throws std::invalid_argument otherwise.
  /// Reads ros::Time::now(), so ROS time must be initialised.
  explicit TriggerRate(double rate = 30.0);

  /// @param start where the first period begins; ROS time need not be initialised.
  TriggerRate(double rate, const ros::Time& start);

  /// True when a period has passed since the last time it was true; looks at ros::Time::now().
  bool operator()();

  /// The same with the loop's own time.
  bool operator()(const ros::Time& now) noexcept;

 private:
  ros::Time time_stamp_;
  ros::Duration period_;
};

}  // namespace franka_hw
