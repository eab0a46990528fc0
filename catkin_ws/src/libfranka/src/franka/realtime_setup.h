// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>
#include <sys/mman.h>

#include <string>

namespace franka {

/// Prepares the calling thread for the 1 kHz loop: highest priority of SCHED_FIFO and, if enforced,
/// lockMemory(). With kIgnore a failure to get the priority is ignored. Not real-time safe.
/// @returns what lockMemory() returns
/// @throws RealtimeException if enforced and the kernel or the priority is not available.
std::string prepareControlThread(RealtimeConfig realtime_config);

/// Locks the program's memory as far as permitted. Not real-time safe.
/// @param lock mlockall; tests have their own
/// @returns a warning if that failed, which is not an error; else nothing
std::string lockMemory(int (*lock)(int) = mlockall);

}  // namespace franka
