// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "connection_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_info {

namespace {
// Clocks differ by less than 0.1 %; a robot in lock-step is slower by 5 % or more. Chosen here
// between these values.
constexpr double kSamePace = 0.01;
}  // namespace

void ConnectionStatistics::add(franka::Duration robot_time, Clock::time_point now) {
  const std::uint64_t time = robot_time.toMSec();
  if (received_ > 0 && time > last_time_ + 1) {
    const std::uint64_t gap = time - last_time_ - 1;
    lost_ += gap;
    most_lost_ = std::max(most_lost_, gap);
  }
  received_++;
  last_time_ = time;
  times_.push_back(static_cast<double>(time));
  offsets_.push_back(std::chrono::duration<double, std::milli>(now.time_since_epoch()).count() -
                     static_cast<double>(time));
}

double ConnectionStatistics::rate() const {
  const std::uint64_t sent = received_ + lost_;
  return sent > 0 ? static_cast<double>(received_) / static_cast<double>(sent) : 0.0;
}

double ConnectionStatistics::lateness(double quantile) const {
  return quantileOf(offsets_, quantile) - quantileOf(offsets_, 0.0);
}

double ConnectionStatistics::pace() const {
  const auto middle = offsets_.begin() + static_cast<std::ptrdiff_t>(offsets_.size() / 2);
  const auto first = std::min_element(offsets_.begin(), middle);
  const auto second = std::min_element(middle, offsets_.end());
  if (first == middle || second == offsets_.end()) {
    return 1.0;
  }
  const auto time = [this](auto at) {
    return times_[static_cast<std::size_t>(at - offsets_.begin())];
  };
  const double robot = time(second) - time(first);
  return robot / (robot + *second - *first);
}

bool ConnectionStatistics::keepsTime() const { return std::abs(pace() - 1.0) < kSamePace; }

double quantileOf(std::vector<double> values, double quantile) {
  if (values.empty()) {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(quantile * static_cast<double>(values.size() - 1))];
}

}  // namespace franka_info
