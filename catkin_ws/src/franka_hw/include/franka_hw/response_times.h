// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>
#include <realtime_tools/latest_value.h>

#include <atomic>
#include <chrono>
#include <cstdint>

namespace franka_hw {

/// Measures how fast commands answer states during a motion, and how evenly states arrive.
///
/// A command is sent when the loop has computed it, so the response time is this host's share of
/// the round trip. The network's share cannot be measured here as a whole, because the robot does
/// not report when it sends. But the robot sends once per millisecond of its own time: the delay of
/// a state relative to the state with the least delay shows the variation caused by the network and
/// by the wake-up of this host. The robot itself reports whether commands arrive in time
/// (control_command_success_rate).
///
/// One thread calls the functions of a motion, another one take(). Real-time safe.
class ResponseTimes {
 public:
  using Clock = std::chrono::steady_clock;  ///< of the times that are measured

  /// Of the cycles since the last report; all zero if there were none.
  struct Report {
    std::uint64_t cycles{0};  ///< commands
    double mean{0.0};         ///< from a state to the command computed from it [s]
    double longest{0.0};      ///< of these [s]
    double spread{0.0};       ///< largest delay minus least delay of the states of a motion [s]
  };

  /// Delays before this call are not compared with delays after it.
  void motionBegins() noexcept;
  /// A state has arrived. Does nothing if called again for the same state of a motion, as with two
  /// callbacks in a cycle.
  void stateArrived(franka::Duration robot_time, Clock::time_point now) noexcept;
  /// The arrival time of the latest state.
  Clock::time_point lastArrival() const noexcept { return last_arrival_; }
  /// A command is ready; it was computed from a state that arrived at `since`. If a cycle has
  /// several calls, the last one counts.
  void commandReady(Clock::time_point since, Clock::time_point now) noexcept;

  /// The report of the cycles since the last call. Called by one thread.
  Report take() noexcept;

 private:
  struct Window {
    std::uint64_t cycles{0};
    Clock::duration total{0}, longest{0}, spread{0};
  };

  void noteDelay(franka::Duration robot_time, Clock::time_point now) noexcept;

  // Used by the moving thread only.
  bool begins_{true};
  franka::Duration last_time_;
  Clock::time_point last_arrival_{};
  Clock::duration response_{-1};                       // of the present cycle; negative: none yet
  Clock::duration least_delay_{0}, largest_delay_{0};  // of this motion, since the last report
  Window window_;

  realtime_tools::LatestValue<Window> published_;
  std::atomic_bool restarts_{true};  // the next cycle begins another report
};

}  // namespace franka_hw
