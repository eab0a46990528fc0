// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

/// Filters of single numbers, without state. Real-time safe. Thread-safe.
namespace filters {

/// The value, or the nearest limit if it lies outside. @param low not above `high`
template <class T>
inline T clamp(const T& value, const T& low, const T& high) {
  return std::min(std::max(value, low), high);
}

/// One step of a first-order low-pass filter.
/// @param alpha in [0, 1]: 1 follows the raw value at once, 0 keeps the last one. For a sample
/// period dt and a time constant tau it is 1 - exp(-dt / tau).
/// @returns the new smoothed value
inline double exponentialSmoothing(double current_raw_value, double last_smoothed_value,
                                   double alpha) {
  return last_smoothed_value + alpha * (current_raw_value - last_smoothed_value);
}

}  // namespace filters
/// @cond
namespace control_toolbox {
namespace filters = ::filters;
}
/// @endcond
