// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

/// @file
/// Checks of commands, and the realtime set-up of a control thread.

namespace franka {

/// Whether the sign of the elbow is exactly +1 or -1. Real-time safe.
/// @param elbow position of joint 3 [rad] and sign of joint 4.
bool isValidElbow(const std::array<double, 2>& elbow) noexcept;

/// Whether a 4x4 column-major matrix is a homogeneous transformation: bottom row exactly (0, 0, 0,
/// 1), every row and column of the rotation of length 1 within 1e-5. Orthogonality is not checked,
/// as in the genuine client. Real-time safe.
bool isHomogeneousTransformation(const std::array<double, 16>& transform) noexcept;

/// Whether the running kernel reports that it is a realtime kernel (PREEMPT_RT).
/// Not real-time safe.
bool hasRealtimeKernel();

/// Gives the calling thread the highest priority of the realtime scheduler SCHED_FIFO.
/// Not real-time safe.
/// @param error_message receives the reason of a failure; may be null.
/// @returns false on failure.
bool setCurrentThreadToHighestSchedulerPriority(std::string* error_message);

}  // namespace franka
