// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <limits>
#include <vector>

namespace franka_sim::physics {

/// Maximum efforts of the equalities that hold joints at positions, which MuJoCo's equalities do
/// not have. In a step in which the solver needs a larger effort than the maximum, the maximum acts
/// in its place, as an applied effort, and the constraints are solved again without the equality.
///
/// A joint that lags behind returns as fast as it can brake: beyond the range in which the
/// equality's own law needs less than the acceleration a, its velocity towards the position is
///
///     v = v_target + sqrt(a (2 e - a T^2)),   a = (max_effort - load) / (2 M)
///
/// for the lag e without that of a steady motion, and the law's lag T per velocity. Half of the
/// effort is a reserve for what M, the joint's inertia with all others held, does not contain
/// (chosen here). The joint does not return faster than the maximum velocity.
///
/// Steps in which no maximum matters are the same to the last bit as without one. Called by the
/// stepping thread. Real-time safe. Exception: `fit`.
class HoldLimits {
 public:
  struct Hold {
    double max_effort{std::numeric_limits<double>::infinity()};    ///< [Nm|N]; infinity: none
    double max_velocity{std::numeric_limits<double>::infinity()};  ///< [rad/s|m/s]
    double velocity{0};  ///< of the position in this tick [rad/s|m/s]
  };

  /// Call for a new model: no hold has a maximum.
  void fit(const mjModel& model);
  /// @param equality of one joint
  void set(int equality, const Hold& hold) noexcept;
  /// Call before the constraints of a step are solved.
  void limitReturn(const mjModel& model, mjData* data) noexcept;
  /// Call after each solution of the constraints of a step, until it returns false.
  /// @returns whether they must be solved again, because it has replaced equalities
  bool replaceExceeded(const mjModel& model, mjData* data) noexcept;

 private:
  bool isLimited(int equality) const noexcept;

  std::vector<Hold> holds_;          ///< by equality
  std::vector<double> replacement_;  ///< by equality: the effort that acts in its place [Nm|N]
  int limited_{0};                   ///< number of equalities with a maximum effort
};

}  // namespace franka_sim::physics
