// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace guard {

/// Number of allocations and locks of an action. The guard's own header may be included in one file
/// only.
std::size_t allocationsAndLocks(const std::function<void()>& action);

}  // namespace guard
