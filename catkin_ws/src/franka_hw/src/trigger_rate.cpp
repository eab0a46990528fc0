// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_hw/trigger_rate.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace franka_hw {

namespace {

/// Longest period [s]; slower rates do not fire within a robot's life in any case.
constexpr double kMaxPeriod = 1e9;

ros::Duration periodOf(double rate) {
  if (!std::isfinite(rate) || rate <= 0.0) {
    throw std::invalid_argument("TriggerRate: a rate must be a number above 0 Hz, not " +
                                franka_core::numberText(rate) + ".");
  }
  ros::Duration period;
  period.fromNSec(std::max<std::int64_t>(1, std::llround(std::min(1.0 / rate, kMaxPeriod) * 1e9)));
  return period;
}

}  // namespace

TriggerRate::TriggerRate(double rate) : TriggerRate(rate, ros::Time::now()) {}

TriggerRate::TriggerRate(double rate, const ros::Time& start)
    : time_stamp_(start), period_(periodOf(rate)) {}

bool TriggerRate::operator()() { return (*this)(ros::Time::now()); }

bool TriggerRate::operator()(const ros::Time& now) noexcept {
  const std::int64_t stamp = static_cast<std::int64_t>(time_stamp_.toNSec());
  const std::int64_t elapsed = static_cast<std::int64_t>(now.toNSec()) - stamp;
  if (elapsed < 0) {
    time_stamp_ = now;
    return false;
  }
  const std::int64_t period = period_.toNSec();
  if (elapsed < period) {
    return false;
  }
  time_stamp_.fromNSec(static_cast<std::uint64_t>(stamp + elapsed / period * period));
  return true;
}

}  // namespace franka_hw
