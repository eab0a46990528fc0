// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

namespace franka_sim::physics {

/// Simplifies the meshes of a model that is only drawn, and shades them smoothly up to edges of 30
/// degrees (decision 63). They lose their convex hulls. Meshes with texture coordinates stay as
/// they are. Not real-time safe.
void simplifyDrawnMeshes(mjModel* model);

}  // namespace franka_sim::physics
