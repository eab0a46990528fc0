// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>

#include <array>

#include "robot/transforms.h"

namespace franka_sim {

/// Joint positions for a pose of the end effector and a position of joint 3 (decision 12).
///
/// Newton's method on the Jacobian of EE extended by a row for joint 3, from the joint positions of
/// the last tick. Where that matrix is nearly singular (smallest singular value below 0.02), one
/// step of damped least squares replaces it: the arm then follows as well as it can.
/// Real-time safe.
class InverseKinematics {
 public:
  struct Solution {
    std::array<double, 7> q{};          ///< [rad]
    Transform O_T_EE{};                 ///< pose of the end effector at q
    std::array<double, 42> jacobian{};  ///< at q, 6x7 column-major, in O
    bool near_singularity{false};
  };

  /// Whether the pose is too singular to start a Cartesian motion: smallest singular value below
  /// 0.01.
  static bool isSingular(const std::array<double, 7>& q, const Transform& F_T_EE,
                         const franka_core::ArmModel& model) noexcept;

  /// @param q_last start of the search [rad] @param O_T_EE desired pose @param q3 desired [rad]
  static Solution solve(const std::array<double, 7>& q_last, const Transform& O_T_EE, double q3,
                        const Transform& F_T_EE, const franka_core::ArmModel& model) noexcept;
};

}  // namespace franka_sim
