// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>

namespace franka {

/// Makes the calling thread fit for the 1 kHz loop: highest priority of SCHED_FIFO, and, where
/// enforced, memory locked as far as this process may (a failure to lock is no error). With kIgnore
/// the priority is tried for and done without.
/// @throws RealtimeException if enforced and the kernel has no realtime, or the priority cannot be
/// had.
void prepareControlThread(RealtimeConfig realtime_config);

}  // namespace franka
