// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// Progress towards a target of franka::AsyncPositionControlHandler.

namespace franka {

/// Progress towards a target.
enum class TargetStatus {
  kIdle,           ///< no target has been set
  kExecuting,      ///< on the way
  kTargetReached,  ///< there, and at rest
  kAborted         ///< the motion has ended; configure a new handler
};

}  // namespace franka
