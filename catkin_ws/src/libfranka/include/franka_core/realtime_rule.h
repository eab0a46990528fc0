// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// @file
/// Whether a motion needs a real-time kernel: one rule for the client and for the nodes
/// (decisions 27, 49).

struct sockaddr;  // NOLINT(readability-identifier-naming)  the system's name

namespace franka_core {

/// Whether a socket's address is one of this machine's loopback addresses: 127.0.0.0/8, ::1, or the
/// unspecified address, which reaches the same. Real-time safe.
bool isLoopback(const sockaddr& address) noexcept;

/// Whether a robot's address, with or without a port, names loopback addresses only: `127.0.0.2`,
/// `localhost:1340`, `::1`, `[::1]:1337`. A name that cannot be resolved does not. May ask the
/// system's name resolver. Not real-time safe. Thread-safe.
bool isLoopback(const std::string& address);

/// Rule for threads that control a robot.
struct RealtimeRule {
  bool enforce;         ///< refuse to control the robot without real-time kernel and priority
  std::string warning;  ///< a sentence if less is enforced than requested; else empty
};

/// A robot on a loopback address is simulated and needs no real-time kernel: on a kernel without
/// real-time support enforcement becomes a warning. Only for such addresses the environment
/// variable FRANKA_REALTIME overrides this: `enforce` as on other addresses, `ignore` never
/// enforces and never warns. For other addresses the request applies.
/// Not real-time safe. Thread-safe.
/// @param enforce the request: RealtimeConfig::kEnforce, or `realtime_config: enforce`.
/// @param is_loopback result of isLoopback for the robot's address.
/// @param has_realtime_kernel result of franka::hasRealtimeKernel.
/// @throws std::invalid_argument with a sentence if FRANKA_REALTIME applies and is neither.
RealtimeRule realtimeRule(bool enforce, bool is_loopback, bool has_realtime_kernel);

}  // namespace franka_core
