// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace controller_manager {
namespace internal {

/// Mean, spread and maximum of durations [s]. Called by one thread at a time. Real-time safe.
class TimeStatistics {
 public:
  /// Welford's recurrence: avoids differences of large sums.
  void add(double seconds) {
    ++count_;
    const double distance = seconds - mean_;
    mean_ += distance / static_cast<double>(count_);
    squares_ += distance * (seconds - mean_);
    max_ = std::max(max_, seconds);
  }
  void addOverrun(double stamp) {
    ++overruns_;
    last_overrun_ = stamp;
  }

  std::uint64_t count() const { return count_; }
  double mean() const { return mean_; }
  double max() const { return max_; }
  double variance() const { return count_ > 0 ? squares_ / static_cast<double>(count_) : 0.0; }
  std::uint32_t overruns() const { return overruns_; }
  double lastOverrun() const { return last_overrun_; }  ///< [s] on the loop's clock

 private:
  std::uint64_t count_{0};
  double mean_{0.0}, squares_{0.0}, max_{0.0};
  std::uint32_t overruns_{0};
  double last_overrun_{0.0};
};

/// A pair: the loop writes one, the other is read outside. The loop's gate selects which.
typedef std::array<TimeStatistics, 2> TimeStatisticsPair;

}  // namespace internal
}  // namespace controller_manager
