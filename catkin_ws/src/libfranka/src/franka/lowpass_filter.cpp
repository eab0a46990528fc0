// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/lowpass_filter.h>
#include <franka_core/finite.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "franka/nearest_rotation.h"

namespace franka {

namespace {

constexpr double kPi = 3.14159265358979323846;

void require(bool condition, const char* sentence) {
  if (!condition) {
    throw std::invalid_argument(sentence);
  }
}

double gainOf(double sample_time, double cutoff_frequency) {
  require(std::isfinite(sample_time) && sample_time >= 0.0,
          "libfranka lowpass filter: the sample time must be finite and not negative.");
  require(std::isfinite(cutoff_frequency) && cutoff_frequency > 0.0,
          "libfranka lowpass filter: the cutoff frequency must be finite and greater than 0 Hz.");
  return sample_time / (sample_time + 1.0 / (2.0 * kPi * cutoff_frequency));
}

}  // namespace

double lowpassFilter(double sample_time, double y, double y_last, double cutoff_frequency) {
  const double gain = gainOf(sample_time, cutoff_frequency);
  require(std::isfinite(y) && std::isfinite(y_last),
          "libfranka lowpass filter: the values to filter must be finite.");
  return gain * y + (1.0 - gain) * y_last;
}

std::array<double, 16> cartesianLowpassFilter(double sample_time, std::array<double, 16> y,
                                              std::array<double, 16> y_last,
                                              double cutoff_frequency) {
  const double gain = gainOf(sample_time, cutoff_frequency);
  require(franka_core::allFinite(y) && franka_core::allFinite(y_last),
          "libfranka lowpass filter: the poses to filter must be finite.");
  std::array<double, 16> filtered = y;
  Eigen::Map<Eigen::Matrix4d> matrix(filtered.data());
  const Eigen::Quaterniond from(nearestRotation(y_last));
  const Eigen::Quaterniond to(nearestRotation(y));
  matrix.topLeftCorner<3, 3>() = from.slerp(gain, to).toRotationMatrix();
  for (std::size_t i = 12; i < 15; i++) {
    filtered[i] = gain * y[i] + (1.0 - gain) * y_last[i];
  }
  return filtered;
}

}  // namespace franka
