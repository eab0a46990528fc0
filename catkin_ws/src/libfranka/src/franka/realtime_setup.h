// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>

namespace franka {

/// Prepares the calling thread for the 1 kHz loop: highest priority of SCHED_FIFO and, if enforced,
/// memory locked as far as permitted (a failure to lock is not an error). With kIgnore a failure to
/// get the priority is ignored. Not real-time safe.
/// @throws RealtimeException if enforced and the kernel or the priority is not available.
void prepareControlThread(RealtimeConfig realtime_config);

}  // namespace franka
