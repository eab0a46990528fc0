// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace franka_core {

/// Whether every number of a range is finite: neither infinite nor NaN. Real-time safe.
/// Thread-safe.
template <typename Range>
bool allFinite(const Range& values) noexcept {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

}  // namespace franka_core
