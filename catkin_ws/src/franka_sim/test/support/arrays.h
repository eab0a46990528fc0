// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace franka_sim::test {

template <std::size_t N>
void expectNear(const std::array<double, N>& expected, const std::array<double, N>& values,
                double tolerance) {
  for (std::size_t i = 0; i < N; i++) {
    EXPECT_NEAR(expected[i], values[i], tolerance) << i;
  }
}

template <std::size_t N>
double largestDifference(const std::array<double, N>& a, const std::array<double, N>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < N; i++) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

/// The Euclidean norm of `count` values from `first` on.
template <std::size_t N>
double norm(const std::array<double, N>& values, std::size_t first, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; i++) {
    sum += values[i] * values[i];
  }
  return std::sqrt(sum);
}

}  // namespace franka_sim::test
