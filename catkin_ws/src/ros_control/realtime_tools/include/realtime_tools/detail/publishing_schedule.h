// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace realtime_tools {
namespace detail {

/// When the publishing thread checks for the next message of one publisher.
///
/// In a stream of messages it checks once per message, shortly after the next one is expected. If
/// that message does not come, it checks every 0.5 ms, then less often, at last every 5 ms. No
/// thread needs to be woken up for that. Called by one thread at a time.
class PublishingSchedule {
 public:
  using Clock = std::chrono::steady_clock;

  explicit PublishingSchedule(Clock::time_point start = Clock::now()) noexcept : last_(start) {}

  /// @param when the real-time side has handed over a message that was found now.
  void found(Clock::time_point when) noexcept {
    interval_ = when - last_;
    last_ = when;
  }

  /// The time of the next check.
  Clock::time_point next(Clock::time_point now) const noexcept;

 private:
  /// Between messages that come in a stream [chosen here: slower ones need no precise checks].
  static constexpr std::chrono::milliseconds kMaxInterval{2};
  /// The real-time side may be late by this, and fills the messages of several publishers one after
  /// the other. Chosen here.
  static constexpr std::chrono::microseconds kMargin{60};
  /// Twice in a cycle of the fastest loops, so that a message is taken before the next one is due,
  /// whatever the phase of the checks.
  static constexpr std::chrono::microseconds kMinWait{500};
  static constexpr std::chrono::microseconds kMaxWait{5000};

  Clock::time_point last_;  ///< hand-over of the last message
  Clock::duration interval_{Clock::duration::max()};
};

}  // namespace detail
}  // namespace realtime_tools
