// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "connection_statistics.h"

#include <algorithm>

namespace franka_info {

void ConnectionStatistics::add(franka::Duration robot_time, Clock::time_point now) {
  const std::uint64_t time = robot_time.toMSec();
  if (received_ > 0 && time > last_time_ + 1) {
    const std::uint64_t gap = time - last_time_ - 1;
    lost_ += gap;
    most_lost_ = std::max(most_lost_, gap);
  }
  received_++;
  last_time_ = time;
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

double quantileOf(std::vector<double> values, double quantile) {
  if (values.empty()) {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(quantile * static_cast<double>(values.size() - 1))];
}

}  // namespace franka_info
