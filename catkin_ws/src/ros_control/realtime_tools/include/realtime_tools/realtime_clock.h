// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <ros/time.h>

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

namespace realtime_tools {

/// Converts the time of a real-time loop to system time without a system call.
///
/// Its own thread samples the system's time (ros::Time::now()) 750 times a second; the loop
/// compares its own time with the samples and follows the difference of both clocks slowly, so that
/// the result has no jitter of either.
///
/// Threads: getSystemTime() is for one real-time thread and wait-free: no lock, no system call, no
/// allocation. Construction and destruction are for other threads. The original logs frequent
/// failures of its lock; here no lock exists, so nothing is logged.
class RealtimeClock {
 public:
  /// Starts the thread. Requires ros::init() or ros::Time::init().
  RealtimeClock();
  /// Ends the thread, within one of its periods.
  ~RealtimeClock();
  RealtimeClock(const RealtimeClock&) = delete;
  RealtimeClock& operator=(const RealtimeClock&) = delete;

  /// The system time at a time of the loop.
  ///
  /// @param realtime_time of the loop, increasing from call to call.
  /// @return realtime_time plus the estimated difference of the clocks; realtime_time itself until
  /// the first sample, or if the sum is not a valid time.
  ros::Time getSystemTime(const ros::Time& realtime_time);

  /// Samples the system's time now. Thread-safe. For tests, which set that time.
  void sample();

  /// The body of the thread, public as in the original; not for callers.
  void loop();

 private:
  /// Updates the difference by a sample at `system_time` [s].
  void follow(double realtime_time, double system_time);

  // Written by the thread: nanoseconds since the epoch, 0 before the first sample.
  std::atomic<std::int64_t> noted_{0};
  std::atomic<bool> running_{true};
  std::mutex sampling_;

  // Used by the real-time thread only.
  std::int64_t used_{0};          ///< the last used sample
  double last_realtime_time_{0};  ///< [s]
  double offset_{0};              ///< system time minus the loop's [s]
  bool initialized_{false};

  std::thread thread_;
};

}  // namespace realtime_tools
