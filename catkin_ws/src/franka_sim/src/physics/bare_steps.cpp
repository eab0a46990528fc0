// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/bare_steps.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "physics/world_impl.h"

namespace franka_sim {

namespace {

/// Under held torques an arm drifts away from its controlled pose: restart this often [ticks].
constexpr std::uint32_t kRound = 200;

/// Computing time of this thread [us]: excludes other programs.
double threadMicroseconds() noexcept {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

}  // namespace

double bareTickMicroseconds(World& world, std::uint32_t ticks) {
  const mjModel* model = implOf(world).model.get();
  const mjData* present = implOf(world).data.get();
  const physics::DataPtr copy = physics::copyData(*model, *present);
  const auto substeps = static_cast<std::uint32_t>(std::lround(World::kTick / model->opt.timestep));
  double spent = 0.0;
  for (std::uint32_t done = 0; done < ticks; done += kRound) {
    physics::copyData(copy.get(), *model, *present);
    const std::uint32_t steps = std::min(kRound, ticks - done) * substeps;
    const double start = threadMicroseconds();
    for (std::uint32_t i = 0; i < steps; ++i) {
      mj_step(model, copy.get());
    }
    spent += threadMicroseconds() - start;
  }
  return spent / std::max(ticks, 1U);
}

}  // namespace franka_sim
