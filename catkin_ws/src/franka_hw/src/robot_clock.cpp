// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/robot_clock.h>

#include <algorithm>
#include <cmath>

namespace franka_hw {

namespace {

// Beyond this the two clocks are unrelated: simulated time was reset, or the robot stood still. [s]
constexpr double kLost = 0.5;
// The largest adjustment to the clock of ROS, as a share of the elapsed time.
constexpr double kSlew = 0.01;

/// Avoids the exception that ros::Time throws if a sum leaves its range: 32 bits of seconds hold
/// every sum here, except one below zero.
ros::Time later(const ros::Time& time, double seconds) noexcept {
  ros::Time sum;
  const double total = std::max(0.0, seconds);
  const auto whole = static_cast<std::uint32_t>(total);
  const auto nanoseconds = static_cast<std::uint64_t>(time.nsec) +
                           static_cast<std::uint64_t>(std::llround((total - whole) * 1e9));
  sum.sec = time.sec + whole + static_cast<std::uint32_t>(nanoseconds / 1000000000U);
  sum.nsec = static_cast<std::uint32_t>(nanoseconds % 1000000000U);
  return sum;
}

/// [s] from one time to another.
double between(const ros::Time& from, const ros::Time& to) noexcept {
  return (static_cast<double>(to.sec) - static_cast<double>(from.sec)) +
         1e-9 * (static_cast<double>(to.nsec) - static_cast<double>(from.nsec));
}

}  // namespace

ros::Time RobotClock::update(franka::Duration robot_time, const ros::Time& now) noexcept {
  const double robot_seconds = robot_time.toSec();
  const double passed = robot_seconds - robot_seconds_;
  const bool continues = started_ && passed >= 0.0 && passed < kLost;
  robot_seconds_ = robot_seconds;
  if (!started_) {
    started_ = true;
    time_ = now;
    return time_;
  }
  const double behind = continues ? between(later(time_, passed), now) : between(time_, now);
  if (!continues || behind > kLost) {
    time_ = later(time_, std::max(0.0, between(time_, now)));
    return time_;
  }
  const double correction = std::clamp(behind, -kSlew * passed, kSlew * passed);
  time_ = later(time_, passed + correction);
  return time_;
}

}  // namespace franka_hw
