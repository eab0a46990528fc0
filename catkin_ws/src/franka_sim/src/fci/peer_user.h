// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>

namespace franka_sim::fci {

/// The user whose process has the other end of a TCP connection over IPv4. Nothing if that end is
/// not on this machine or in another network namespace, if no process has it any more, or if the
/// system gives no answer. Thread-safe. Does not block.
std::optional<uid_t> peerUser(int connection) noexcept;

}  // namespace franka_sim::fci
