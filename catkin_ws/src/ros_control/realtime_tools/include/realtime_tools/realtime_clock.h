// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <ros/time.h>

#include <atomic>
#include <cstdint>
#include <thread>

namespace realtime_tools {

/// Translates the time of a real-time loop into system time without asking the system for it.
///
/// A thread of its own notes the system's time (ros::Time::now()) 750 times a second; the loop
/// compares its own time with the notes and follows the difference between the two clocks slowly,
/// so that the result has no jitter of either.
///
/// Threads: getSystemTime() belongs to one real-time thread and is wait-free: no lock, no system
/// call, no allocation. Construction and destruction belong to other threads. The original logs
/// when its lock was missed often; here nothing can be missed, so nothing is logged.
class RealtimeClock {
 public:
  /// Starts the thread. ros::Time must be usable (ros::init() or ros::Time::init() called).
  RealtimeClock();
  /// Ends the thread, within one of its periods.
  ~RealtimeClock();
  RealtimeClock(const RealtimeClock&) = delete;
  RealtimeClock& operator=(const RealtimeClock&) = delete;

  /// The system's time that belongs to a time of the loop.
  ///
  /// @param realtime_time of the loop, growing from call to call.
  /// @return realtime_time plus the estimated difference of the clocks; realtime_time itself until
  /// the thread has noted the time once, or where the sum would be no valid time.
  ros::Time getSystemTime(const ros::Time& realtime_time);

  /// The body of the thread, public as in the original; not for callers.
  void loop();

 private:
  /// Follows the clocks with a sample taken at `system_time` [s].
  void follow(double realtime_time, double system_time);

  // Written by the thread: nanoseconds since the epoch, 0 before the first note.
  std::atomic<std::int64_t> noted_{0};
  std::atomic<bool> running_{true};

  // The real-time thread's own.
  std::int64_t used_{0};          ///< the note that was last made use of
  double last_realtime_time_{0};  ///< [s]
  double offset_{0};              ///< system time minus the loop's [s]
  bool initialized_{false};

  std::thread thread_;
};

}  // namespace realtime_tools
