// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

namespace control_toolbox {

/// White noise with a normal distribution about zero, to overcome stiction of a joint. The same
/// seed gives the same noise. Called by one thread. Real-time safe. Exception: init().
class Dither {
 public:
  /// @param amplitude standard deviation, in the unit of the result
  /// @param seed only its integer part counts
  /// @returns false, without changes, if the amplitude is not finite or negative, or the seed is no
  /// 32-bit number
  bool init(double amplitude, double seed);

  /// The next value; zero before init().
  double update();

 private:
  double amplitude_{0.0};
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace control_toolbox
