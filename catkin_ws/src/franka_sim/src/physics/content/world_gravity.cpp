// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/world_gravity.h>

#include <algorithm>

#include "physics/world/world_impl.h"

namespace franka_sim {

std::array<double, 3> gravity(const World& world) {
  const double* g = implOf(world).model->opt.gravity;
  return {g[0], g[1], g[2]};
}

void setGravity(World& world, const std::array<double, 3>& gravity) {
  sizes::check(gravity, sizes::kMaxGravity, "m/s^2", "Gravity");
  World::Impl& impl = implOf(world);
  impl.set_gravity = gravity;
  std::copy(gravity.begin(), gravity.end(), impl.model->opt.gravity);
  impl.disturb();
}

}  // namespace franka_sim
