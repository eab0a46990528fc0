// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/physics/bare_steps.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>

#include "physics/world_impl.h"

namespace franka_sim_mujoco {

namespace {

/// Under held torques an arm drifts away from where its controller keeps it: begin anew this often
/// [ticks].
constexpr std::uint32_t kRound = 200;

}  // namespace

double bareTickMicroseconds(World& world, std::uint32_t ticks) {
  using Clock = std::chrono::steady_clock;
  const mjModel* model = world.impl().model.get();
  const mjData* present = world.impl().data.get();
  physics::DataPtr copy(mj_copyData(nullptr, model, present));
  Clock::duration spent{0};
  for (std::uint32_t done = 0; done < ticks; done += kRound) {
    mj_copyData(copy.get(), model, present);
    const std::uint32_t steps = std::min(kRound, ticks - done) * World::kSubsteps;
    const auto start = Clock::now();
    for (std::uint32_t i = 0; i < steps; ++i) {
      mj_step(model, copy.get());
    }
    spent += Clock::now() - start;
  }
  return std::chrono::duration<double, std::micro>(spent).count() / std::max(ticks, 1U);
}

}  // namespace franka_sim_mujoco
