// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <cmath>

#include "physics/joints/hold_limits.h"
#include "physics/joints/motor_side.h"
#include "physics/stepping/preparation_thread.h"

namespace franka_sim::physics {

/// Indices of a joint with one degree of freedom in the present model.
struct JointSlot {
  int qpos{-1}, dof{-1};
  int brake{-1};  ///< equality, -1: it has none
};

/// The model and state that plants use; replaced when the model is recompiled.
struct PlantView {
  mjModel* model{nullptr};
  mjData* data{nullptr};
  MotorSide* motor_side{nullptr};
  HoldLimits* hold_limits{nullptr};
  /// Must have finished before a hold is written, which a preparation reads; null: there is none.
  PreparationThread* preparation_thread{nullptr};
};

/// Closes or opens a joint's brake. The equality holds q - qpos0 at its constant term.
void writeHold(const PlantView& view, const JointSlot& slot, bool closed, double position) noexcept;

/// A NaN would make MuJoCo reset the whole world; zero torque is less harmful.
inline double finiteOrZero(double value) noexcept { return std::isfinite(value) ? value : 0.0; }

}  // namespace franka_sim::physics
