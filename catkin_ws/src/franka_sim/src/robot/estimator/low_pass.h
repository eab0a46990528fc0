// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>

#include <array>
#include <cstddef>

namespace franka_sim {

/// First-order low-pass filters for N signals sampled once a tick (protocol 5.6). Called by one
/// thread. Real-time safe.
template <std::size_t N>
class LowPass {
 public:
  /// @param cutoff [Hz], positive
  explicit LowPass(double cutoff = kSignalCutoff) noexcept { gains_.fill(gainFor(cutoff)); }
  /// @param cutoffs of each signal [Hz], positive
  explicit LowPass(const std::array<double, N>& cutoffs) noexcept {
    for (std::size_t i = 0; i < N; i++) {
      gains_[i] = gainFor(cutoffs[i]);
    }
  }

  const std::array<double, N>& update(const std::array<double, N>& input) noexcept {
    for (std::size_t i = 0; i < N; i++) {
      output_[i] = gains_[i] * input[i] + (1.0 - gains_[i]) * output_[i];
    }
    return output_;
  }

  const std::array<double, N>& output() const noexcept { return output_; }
  void restart() noexcept { output_.fill(0.0); }

 private:
  static double gainFor(double cutoff) noexcept {
    return kTick / (kTick + 1.0 / (2.0 * 3.14159265358979323846 * cutoff));
  }

  std::array<double, N> gains_{};
  std::array<double, N> output_{};
};

}  // namespace franka_sim
