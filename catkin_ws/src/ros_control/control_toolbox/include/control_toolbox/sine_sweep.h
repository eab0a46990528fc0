// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace control_toolbox {

/// A sine wave whose frequency changes exponentially: each octave takes the same time. Called by
/// one thread. Real-time safe.
class SineSweep {
 public:
  /// @param start_freq [Hz] @param end_freq [Hz] @param duration [s] of the sweep
  /// @param amplitude in the unit of the result
  /// @returns false, without changes, unless all are finite and above zero
  bool init(double start_freq, double end_freq, double duration, double amplitude);

  /// @param time [s] since the sweep's start
  /// @returns the value; zero before init(), before the start and after the end
  double update(double time);

 private:
  double start_{0.0};     ///< angular frequency at the start [rad/s]
  double growth_{0.0};    ///< of the logarithm of the frequency [1/s]
  double duration_{0.0};  ///< [s]
  double amplitude_{0.0};
};

}  // namespace control_toolbox
