// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

namespace franka_sim::physics {

/// mj_step1. If there are more constraints than the model has room for, the contacts of each pair
/// of shapes share their friction: two of them get all of it, the others only press. Allocates
/// nothing.
void firstHalf(const mjModel* model, mjData* data);

/// mj_fwdConstraint. MuJoCo's Newton method factorizes a matrix of all objects that touch each
/// other, at a cost that grows with the cube of their number: a pile of 200 cubes takes 0.8 s a
/// step. With many contacts between objects, conjugate gradients solve the constraints instead, in
/// 0.01 to 0.06 s (docs/performance.md). It depends on the present contacts alone, so that runs
/// repeat. A model that asks for another solver keeps it. Allocates nothing.
void solveConstraints(const mjModel& model, mjData* data);

}  // namespace franka_sim::physics
