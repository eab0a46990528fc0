// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace franka_example_controllers {

/// Brings velocities to rest without a jump: each follows the cubic from the present velocity and
/// acceleration to zero velocity and acceleration. All take equally long. Real-time safe. Units:
/// any, per second.
template <std::size_t size>
class GentleStop {
 public:
  using Values = std::array<double, size>;

  GentleStop() = default;

  /// @param deceleration largest one of the velocities themselves; accelerations fade in the same
  /// time
  GentleStop(const Values& velocity, const Values& acceleration, double deceleration)
      : velocity_(velocity), acceleration_(acceleration) {
    double fastest = 0.0;
    for (const double value : velocity) {
      fastest = std::max(fastest, std::abs(value));
    }
    // The cubic's steepest slope is 3/2 of the mean.
    duration_ = std::clamp(1.5 * fastest / deceleration, kMinDuration, kMaxDuration);
  }

  /// @param time since the start [s]; after `duration` the velocities are zero
  Values velocity(double time) const {
    Values values{};
    const double s = std::max(time, 0.0) / duration_;
    if (s >= 1.0) {
      return values;
    }
    const double rest = 1.0 - s;
    for (std::size_t i = 0; i < size; ++i) {
      values[i] = rest * rest * ((1.0 + 2.0 * s) * velocity_[i] + s * duration_ * acceleration_[i]);
    }
    return values;
  }

  double duration() const { return duration_; }  ///< [s]

 private:
  static constexpr double kMinDuration = 0.1;  // [s]
  static constexpr double kMaxDuration = 2.0;  // [s]

  Values velocity_{};
  Values acceleration_{};
  double duration_{kMinDuration};
};

/// The velocity and acceleration of the last of three samples.
template <std::size_t size>
class Differences {
 public:
  using Values = std::array<double, size>;

  /// Resets the history. @param sample at rest
  void reset(const Values& sample) { samples_ = {sample, sample, sample}; }

  /// Takes a value that was measured a period [s] after the one before.
  void add(const Values& sample, double period) {
    samples_ = {samples_[1], samples_[2], sample};
    period_ = period;
  }

  /// The last value.
  const Values& last() const { return samples_[2]; }

  /// Its first derivative; 0 while there is one value only.
  Values first() const {
    Values values{};
    for (std::size_t i = 0; period_ > 0.0 && i < size; ++i) {
      values[i] = (samples_[2][i] - samples_[1][i]) / period_;
    }
    return values;
  }

  /// Its second derivative; 0 while there is one value only.
  Values second() const {
    Values values{};
    for (std::size_t i = 0; period_ > 0.0 && i < size; ++i) {
      values[i] = (samples_[2][i] - 2.0 * samples_[1][i] + samples_[0][i]) / (period_ * period_);
    }
    return values;
  }

 private:
  std::array<Values, 3> samples_{};
  double period_{0.0};
};

}  // namespace franka_example_controllers
