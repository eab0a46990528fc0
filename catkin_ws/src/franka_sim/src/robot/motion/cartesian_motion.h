// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/motion_steps.h>
#include <franka_sim/robot/limits.h>

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

using franka_core::CartesianSample;
using franka_core::ElbowSample;

/// A commanded elbow.
struct ElbowCommand {
  bool valid{false};              ///< false: the last commanded elbow stays
  std::array<double, 2> elbow{};  ///< q3 [rad] and the sign of the elbow, +1 or -1
};

/// The commanded motion of end effector and elbow, with the check of its next step; JointMotion
/// describes how. The norms of the linear and of the angular part of velocity, acceleration and
/// jerk and those of the elbow are checked together (decisions 14, 47). Called by one thread.
/// Real-time safe.
class CartesianMotion {
 public:
  /// At rest. @param pose O_T_EE @param elbow q3 [rad] and its sign.
  void start(const Transform& pose, const std::array<double, 2>& elbow) noexcept;

  /// Takes the next commanded pose O_T_EE; it is kept orthonormalized. The first must be where the
  /// motion starts, and sets the history to rest there.
  /// @param sign the elbow's present sign, which a commanded elbow must have.
  ErrorSet takePose(const Transform& pose, const ElbowCommand& elbow, double sign,
                    const MotionLimits& limits) noexcept;
  /// Takes the next commanded twist in O [m/s, rad/s], from rest on; the pose follows by
  /// integration.
  ErrorSet takeTwist(const std::array<double, 6>& twist, const ElbowCommand& elbow, double sign,
                     const MotionLimits& limits) noexcept;
  /// A step without a command: accelerations are held. Before the first step nothing changes.
  ErrorSet extrapolate(const MotionLimits& limits) noexcept;
  /// Whether end effector and elbow could stand still in the next tick.
  ErrorSet checkStop(const MotionLimits& limits) const noexcept;

  const CartesianSample& last() const noexcept { return last_; }
  /// The last step if it violated a limit; nullptr if it was taken, or was not a motion at all.
  const CartesianSample* refused() const noexcept { return has_refused_ ? &refused_ : nullptr; }

 private:
  ErrorSet checkElbow(const ElbowCommand& elbow, double sign) const noexcept;
  ErrorSet take(const CartesianSample& step, const ErrorSet& errors) noexcept;

  CartesianSample last_, refused_;
  bool started_{false}, has_refused_{false};
};

}  // namespace franka_sim
