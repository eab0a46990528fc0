// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/realtime_setup.h"

#include <franka/control_tools.h>
#include <franka/exception.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <string>

namespace franka {

namespace {

void lockMemory() {
  // Under a limit, later allocations could fail because they cannot be locked.
  rlimit limit{};
  const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  static_cast<void>(mlockall(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT));
}

}  // namespace

void prepareControlThread(RealtimeConfig realtime_config) {
  const bool enforce = realtime_config == RealtimeConfig::kEnforce;
  if (enforce && !hasRealtimeKernel()) {
    throw RealtimeException(
        "libfranka: Running kernel does not have realtime capabilities. Please boot a PREEMPT_RT "
        "kernel (Debian: package linux-image-rt-amd64), or construct the Robot with "
        "RealtimeConfig::kIgnore, as is right for simulated robots on other machines.");
  }
  std::string error;
  if (!setCurrentThreadToHighestSchedulerPriority(&error) && enforce) {
    throw RealtimeException(error);
  }
  if (enforce) {
    lockMemory();
  }
}

}  // namespace franka
