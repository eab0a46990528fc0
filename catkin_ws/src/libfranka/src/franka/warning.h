// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace franka::logging {

/// A warning of the library itself: to the program's sinks or, without any, to standard error.
/// Not real-time safe. Thread-safe.
void warn(const std::string& message);

}  // namespace franka::logging
