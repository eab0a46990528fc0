// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>
#include <controller_manager/internal/command_guard.h>
#include <controller_manager/internal/runs_through.h>
#include <controller_manager/internal/time_statistics.h>
#include <hardware_interface/controller_info.h>
#include <hardware_interface/robot_hw.h>
#include <ros/time.h>

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

namespace controller_manager {
namespace internal {

/// Functions beyond the original, each enabled by its parameter in `<manager's
/// namespace>/controller_manager/`.
struct Supervision {
  double statistics_rate{0.0};         ///< [Hz] of the topic `statistics`; 0: no statistics
  bool abort_faulty{false};            ///< abort a controller that throws or commands NaN
  double max_update_time{0.0};         ///< [s] abort a controller that takes longer; 0: never
  double default_switch_timeout{0.0};  ///< [s] of switches without a timeout; 0: wait for ever

  bool watches() const { return statistics_rate > 0.0 || abort_faulty || max_update_time > 0.0; }
};

/// Runs one controller's updates: measures their time, and aborts a faulty controller while
/// restoring the previous commands. One thread calls update(); a fault is read outside the loop.
class ControllerWatch {
 public:
  enum class Fault { kNone, kException, kRestart, kNotFinite, kTooSlow };

  /// @param controller must outlive the watch
  /// @param fallbacks names of the controllers to start after a fault
  ControllerWatch(controller_interface::ControllerBase& controller,
                  const hardware_interface::ControllerInfo& info,
                  hardware_interface::RobotHW& robot, const Supervision& supervision,
                  std::vector<std::string> fallbacks);

  /// Stops and starts the controller if it runs. Real-time safe. Exception: a controller that
  /// throws.
  void restart(const ros::Time& time);

  /// One cycle. Real-time safe. Exception: a controller that throws.
  /// @param window which of the two statistics to fill
  void update(const ros::Time& time, const ros::Duration& period, std::size_t window);

  /// The fault that has not been handled yet. Thread-safe.
  Fault fault() const { return fault_.load(std::memory_order_acquire); }
  /// The reason, as a clause after "because"; valid while there is a fault.
  std::string reason() const;
  /// The fault has been handled outside: the next one may be set.
  void settle() { fault_.store(Fault::kNone, std::memory_order_release); }

  const std::vector<std::string>& fallbacks() const { return fallbacks_; }
  TimeStatistics& statistics(std::size_t window) { return statistics_[window]; }

 private:
  Fault run(const ros::Time& time, const ros::Duration& period);
  void abort(Fault fault, const ros::Time& time, double elapsed);
  void note(const char* text);

  controller_interface::ControllerBase& controller_;
  const bool abort_faulty_;
  const double max_update_time_;
  const std::vector<std::string> fallbacks_;
  CommandGuard commands_;
  TimeStatisticsPair statistics_;

  std::atomic<Fault> fault_{Fault::kNone};
  // Written by the loop before the fault is set, then unchanged until it is handled.
  ExceptionText text_{};
  double elapsed_{0.0};
};

}  // namespace internal
}  // namespace controller_manager
