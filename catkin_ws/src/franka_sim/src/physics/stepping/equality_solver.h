// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <vector>

namespace franka_sim::physics {

/// Replaces mj_fwdConstraint (decision 61). Constraints that are equalities only, such as the
/// coupling of a hand's fingers and closed brakes, are linear:
///
///     f = -(J M^-1 J^T + R)^-1 (J a_smooth - a_ref),   a = a_smooth + M^-1 J^T f
///
/// which needs one Cholesky factor of their few rows, where MuJoCo's Newton method needs several of
/// all degrees of freedom. All other constraints are left to solveConstraints.
///
/// Called by the stepping thread; allocates only in `fit`.
class EqualitySolver {
 public:
  static constexpr int kMaxRows = 16;  ///< two arms with hands and closed brakes (chosen here)

  /// Call for a new model.
  void fit(const mjModel& model);
  /// Computes constraint forces and accelerations. Real-time safe. @throws EngineError within its
  /// scope
  void solve(const mjModel& model, mjData* data);

 private:
  bool handles(const mjData& data) const noexcept;
  void multiply(const mjModel& model, mjData* data);
  bool factorize(const mjData& data) noexcept;

  using Row = std::array<double, kMaxRows>;

  std::vector<double> jacobian_rows_, solved_rows_;  ///< J^T and M^-1 J^T, row by row
  std::array<Row, kMaxRows> factor_{};               ///< lower triangle
};

}  // namespace franka_sim::physics
