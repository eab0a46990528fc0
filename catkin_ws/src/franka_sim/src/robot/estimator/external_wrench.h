// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "robot/transforms.h"

namespace franka_sim {

/// Wrench at the stiffness frame K from joint torques (decision 5): the undamped pseudo-inverse of
/// J^T, F = (J J^T)^-1 J tau. Where the arm is singular (smallest singular value of J below 0.02)
/// the wrench is not observable and is reported as zero. Forces first [N], then moments about the
/// origin of K [Nm]. Called by one thread. Real-time safe.
class ExternalWrench {
 public:
  /// Computes the map for the present pose.
  /// @param O_T_EE pose of the end effector @param J_EE its zero Jacobian in O, 6x7 column-major
  void update(const Transform& O_T_EE, const std::array<double, 42>& J_EE,
              const Transform& EE_T_K) noexcept;

  /// The wrench in the axes of O.
  std::array<double, 6> inBase(const std::array<double, 7>& tau) const noexcept;
  /// The same wrench in the axes of K.
  std::array<double, 6> inStiffness(const std::array<double, 6>& O_F) const noexcept;

  bool singular() const noexcept { return singular_; }

 private:
  bool singular_{true};
  std::array<double, 42> jacobian_{};  // of K in O, 6x7 column-major
  std::array<double, 36> factor_{};    // Cholesky's, of J J^T; the lower triangle, column-major
  std::array<double, 9> O_R_K_{};      // column-major
};

}  // namespace franka_sim
