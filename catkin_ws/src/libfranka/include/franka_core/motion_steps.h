// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

/// @file
/// Steps of 1 ms of a commanded motion: the arithmetic by which a robot compares a command with the
/// motion before it, and by which a client explains what the robot refused. Pure functions.
/// Real-time safe. Thread-safe.

namespace franka_core {

/// Seven joints at one tick, derivatives by backward differences over 1 ms.
struct JointSample {
  std::array<double, 7> q{};     ///< [rad]
  std::array<double, 7> dq{};    ///< [rad/s]
  std::array<double, 7> ddq{};   ///< [rad/s^2]
  std::array<double, 7> dddq{};  ///< [rad/s^3]
};

/// The elbow's joint (the third) at one tick; derivatives by backward differences.
struct ElbowSample {
  double q3{0.0}, dq3{0.0}, ddq3{0.0}, dddq3{0.0};  ///< [rad], [rad/s], ...
};

/// The end effector in O at one tick, derivatives by backward differences over 1 ms.
struct CartesianSample {
  std::array<double, 16> pose{};         ///< O_T_EE, 4x4 column-major
  std::array<double, 6> twist{};         ///< [m/s, rad/s]
  std::array<double, 6> acceleration{};  ///< [m/s^2, rad/s^2]
  std::array<double, 6> jerk{};          ///< [m/s^3, rad/s^3]
  ElbowSample elbow;                     ///< joint 3
};

/// The step from last to positions [rad].
JointSample stepToPositions(const JointSample& last, const std::array<double, 7>& q) noexcept;
/// The step by velocities [rad/s].
JointSample stepByVelocities(const JointSample& last, const std::array<double, 7>& dq) noexcept;
/// The step that keeps the acceleration.
JointSample stepByAcceleration(const JointSample& last) noexcept;
/// The step of the elbow from last to q3 [rad].
ElbowSample stepToElbow(const ElbowSample& last, double q3) noexcept;

/// The step from last to a pose, with the elbow at q3 [rad].
CartesianSample stepToPose(const CartesianSample& last, const std::array<double, 16>& pose,
                           double q3) noexcept;
/// The step by a twist in O [m/s, rad/s], with the elbow at q3 [rad].
CartesianSample stepByTwist(const CartesianSample& last, const std::array<double, 6>& twist,
                            double q3) noexcept;
/// The step that keeps the accelerations.
CartesianSample stepByAcceleration(const CartesianSample& last) noexcept;

}  // namespace franka_core
