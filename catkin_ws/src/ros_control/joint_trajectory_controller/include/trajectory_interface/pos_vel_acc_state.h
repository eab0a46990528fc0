// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace trajectory_interface {

/// Position, velocity and acceleration of one or more degrees of freedom; [rad] or [m] and their
/// derivatives. A vector is empty if its quantity is not specified.
/// @tparam ScalarType a floating point type
template <class ScalarType>
struct PosVelAccState {
  typedef ScalarType Scalar;  ///< of positions

  PosVelAccState() = default;
  /// All quantities specified, all zero.
  PosVelAccState(unsigned int size)
      : position(size, Scalar(0)), velocity(size, Scalar(0)), acceleration(size, Scalar(0)) {}

  std::vector<Scalar> position;
  std::vector<Scalar> velocity;
  std::vector<Scalar> acceleration;
  Scalar time_from_start{0};  ///< since the trajectory began [s]
};

}  // namespace trajectory_interface
