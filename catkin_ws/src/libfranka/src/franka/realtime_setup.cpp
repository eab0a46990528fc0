// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/realtime_setup.h"

#include <franka/control_tools.h>
#include <franka/exception.h>
#include <sys/resource.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace franka {

std::string lockMemory(int (*lock)(int)) {
  // Under a limit, later allocations could fail because they cannot be locked.
  rlimit limit{};
  const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  if (lock(unlimited ? MCL_CURRENT | MCL_FUTURE : MCL_CURRENT) == 0) {
    return "";
  }
  return std::string("libfranka: This program's memory can be swapped out (mlockall: ") +
         std::strerror(errno) +
         "), and its commands may then be late. Allow your user to lock more of it (limit memlock "
         "in /etc/security/limits.conf).";
}

std::string prepareControlThread(RealtimeConfig realtime_config) {
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
  return enforce ? lockMemory() : "";
}

}  // namespace franka
