// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/detail/publishing_schedule.h"

#include <algorithm>

namespace realtime_tools {
namespace detail {

PublishingSchedule::Clock::time_point PublishingSchedule::next(
    Clock::time_point now) const noexcept {
  if (interval_ <= kMaxInterval && now < last_ + interval_) {
    return std::max(last_ + interval_ + kMargin, now + kMinWait);
  }
  return now + std::clamp<Clock::duration>((now - last_) / 9, kMinWait, kMaxWait);
}

}  // namespace detail
}  // namespace realtime_tools
