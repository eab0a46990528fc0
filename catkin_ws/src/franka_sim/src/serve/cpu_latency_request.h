// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "fci/sockets.h"

namespace franka_sim::fci {

/// Asks the kernel that idle processors of a virtual machine spin instead of halting: a sleeping
/// thread is then woken up within a few microseconds instead of 30 (decision 66).
///
/// This is the kernel's request for a latency of zero (PM QoS, /dev/cpu_dma_latency). It applies to
/// all processors, and the kernel ends it when the process ends. Without the permission to write to
/// that file, and on machines whose processors do not halt in this way, nothing happens.
///
/// Called by one thread. No function throws or allocates; ask() and end() are system calls.
class CpuLatencyRequest {
 public:
  /// @param device, idle_driver the kernel's files; tests have their own.
  explicit CpuLatencyRequest(
      std::string device = "/dev/cpu_dma_latency",
      std::string idle_driver = "/sys/devices/system/cpu/cpuidle/current_driver")
      : device_(std::move(device)), idle_driver_(std::move(idle_driver)) {}

  void ask() noexcept;
  void end() noexcept { open_device_.close(); }

 private:
  std::string device_, idle_driver_;
  Descriptor open_device_;  ///< the request lasts as long as it is open
};

}  // namespace franka_sim::fci
