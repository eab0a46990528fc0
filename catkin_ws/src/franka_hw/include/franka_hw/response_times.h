// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>
#include <franka_hw/latest.h>

#include <atomic>
#include <chrono>
#include <cstdint>

namespace franka_hw {

/// How fast commands answer states during a motion, and how evenly states arrive.
///
/// A command leaves when the loop has it, so the first is this host's share of the round trip. The
/// network's share cannot be measured from here as a whole: the robot does not say when it sends.
/// But it sends once a millisecond of its own time, so that a state's delay behind the promptest
/// one shows: what the network, and the host that wakes up for it, add to its way at times.
/// Whether commands reach the robot in time it says itself (control_command_success_rate).
///
/// One thread moves, another one takes reports. The moving one is real-time safe.
class ResponseTimes {
 public:
  using Clock = std::chrono::steady_clock;

  /// Of the cycles since the last report; all zero when there were none.
  struct Report {
    std::uint64_t cycles{0};
    double mean{0.0};     ///< from a state to the command computed from it [s]
    double longest{0.0};  ///< of these [s]
    double spread{0.0};   ///< the latest state behind the promptest one of its motion [s]
  };

  /// The delays of states before are no measure for those that follow.
  void motionBegins() noexcept;
  /// A state has arrived. Does nothing when called again for the same state of a motion, as with
  /// two callbacks in a cycle.
  void stateArrived(franka::Duration robot_time, Clock::time_point now) noexcept;
  /// When the latest state arrived.
  Clock::time_point lastArrival() const noexcept { return last_arrival_; }
  /// A command is ready that was computed from a state which arrived at `since`. The last one of a
  /// cycle counts.
  void commandReady(Clock::time_point since, Clock::time_point now) noexcept;

  /// What there was since the last call. One thread.
  Report take() noexcept;

 private:
  struct Window {
    std::uint64_t cycles{0};
    Clock::duration total{0}, longest{0}, spread{0};
  };

  void noteDelay(franka::Duration robot_time, Clock::time_point now) noexcept;

  // Of the moving thread.
  bool begins_{true};
  franka::Duration last_time_;
  Clock::time_point last_arrival_{};
  Clock::duration response_{-1};                       // of the cycle under way; negative: none yet
  Clock::duration least_delay_{0}, largest_delay_{0};  // of this motion, since the last report
  Window window_;

  Latest<Window> published_;
  std::atomic_bool starts_anew_{true};  // the next cycle begins another report
};

}  // namespace franka_hw
