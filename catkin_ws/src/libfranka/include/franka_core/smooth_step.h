// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace franka_core {

/// A polynomial of fifth order from 0 to 1 whose velocity and acceleration are zero at both ends.
/// @param share of the time; below 0 and above 1 the ends' values. Real-time safe.
inline double smoothStep(double share) noexcept {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10.0 + s * (6.0 * s - 15.0));
}

}  // namespace franka_core
