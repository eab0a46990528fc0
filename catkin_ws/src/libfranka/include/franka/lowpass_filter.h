// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

/// @file
/// First-order low-pass filters for commands; pure functions. Real-time safe. Thread-safe.

namespace franka {

constexpr double kMaxCutoffFrequency = 1000.0;     ///< from here on commands are not filtered [Hz]
constexpr double kDefaultCutoffFrequency = 100.0;  ///< the control loops' default [Hz]

/// One step of the filter: g y + (1 - g) y_last with g = T / (T + 1 / (2 pi f)).
/// @param sample_time T [s]. @param y new value. @param y_last filtered value of the cycle before.
/// @param cutoff_frequency f [Hz].
/// @throws std::invalid_argument for a negative or not finite time, a frequency that is not
/// positive and finite, or a value that is not finite.
double lowpassFilter(double sample_time, double y, double y_last, double cutoff_frequency);

/// One step for a pose: the translation as above, the rotation along the shortest arc.
/// @param sample_time T [s]. @param y new pose, 4x4 column-major. @param y_last pose of the cycle
/// before.
/// @param cutoff_frequency f [Hz].
/// @throws std::invalid_argument as lowpassFilter.
std::array<double, 16> cartesianLowpassFilter(double sample_time, std::array<double, 16> y,
                                              std::array<double, 16> y_last,
                                              double cutoff_frequency);

}  // namespace franka
