// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace control_toolbox {

/// A sine wave about an offset. Called by one thread. Real-time safe.
class Sinusoid {
 public:
  /// Constant zero.
  Sinusoid() = default;
  /// @param offset mean value @param amplitude in the same unit @param frequency [Hz]
  /// @param phase [rad] at time zero
  Sinusoid(double offset, double amplitude, double frequency, double phase);

  /// @param time [s] @param[out] qd first derivative [1/s] @param[out] qdd second one [1/s^2]
  /// @returns the value
  double update(double time, double& qd, double& qdd);

 private:
  double offset_{0.0};
  double amplitude_{0.0};
  double angular_frequency_{0.0};  ///< [rad/s]
  double phase_{0.0};              ///< [rad]
};

}  // namespace control_toolbox
