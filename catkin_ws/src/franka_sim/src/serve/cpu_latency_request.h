// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "fci/sockets.h"

namespace franka_sim::fci {

/// Requests from the kernel that idle processors of a virtual machine spin instead of halting. A
/// sleeping thread is then woken up within a few microseconds instead of 30 (decision 66).
///
/// The kernel's interface is PM QoS: a latency of zero, written to /dev/cpu_dma_latency. It applies
/// to all processors, and ends with the process. Without the permission to write to that file, and
/// with another idle driver than haltpoll, begin() has no effect.
///
/// Called by one thread. Not real-time safe.
class CpuLatencyRequest {
 public:
  /// @param device, idle_driver the kernel's files; tests have their own.
  explicit CpuLatencyRequest(
      std::string device = "/dev/cpu_dma_latency",
      std::string idle_driver = "/sys/devices/system/cpu/cpuidle/current_driver")
      : device_(std::move(device)), idle_driver_(std::move(idle_driver)) {}

  void begin() noexcept;
  void end() noexcept { open_device_.close(); }

 private:
  std::string device_, idle_driver_;
  Descriptor open_device_;  ///< the request lasts as long as it is open
};

}  // namespace franka_sim::fci
