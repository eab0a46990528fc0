// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

namespace franka_example_controllers {

/// Limits the change of torques between cycles, as the robot requires. Real-time safe. @param tau
/// desired, @param tau_J_d commanded in the last cycle, @param largest_step [Nm]
inline Eigen::Matrix<double, 7, 1> saturateTorqueRate(const Eigen::Matrix<double, 7, 1>& tau,
                                                      const Eigen::Matrix<double, 7, 1>& tau_J_d,
                                                      double largest_step = 1.0) noexcept {
  return tau_J_d + (tau - tau_J_d).cwiseMax(-largest_step).cwiseMin(largest_step);
}

/// The same for arrays.
inline std::array<double, 7> saturateTorqueRate(const std::array<double, 7>& tau,
                                                const std::array<double, 7>& tau_J_d) noexcept {
  using Vector7 = Eigen::Matrix<double, 7, 1>;
  std::array<double, 7> saturated;
  Eigen::Map<Vector7>(saturated.data()) =
      saturateTorqueRate(Vector7(Eigen::Map<const Vector7>(tau.data())),
                         Vector7(Eigen::Map<const Vector7>(tau_J_d.data())));
  return saturated;
}

}  // namespace franka_example_controllers
