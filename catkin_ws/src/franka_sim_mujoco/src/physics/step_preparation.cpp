// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/step_preparation.h"

#include <algorithm>

namespace franka_sim_mujoco::physics {
namespace {

template <typename T>
void keep(std::vector<T>& values, const T* from) noexcept {
  std::copy_n(from, values.size(), values.begin());
}

// Bits are not compared but numbers, for zeros of either sign do the same.
template <typename T>
bool same(const std::vector<T>& values, const T* others) noexcept {
  return std::equal(values.begin(), values.end(), others);
}

}  // namespace

void StepPreparation::fit(const mjModel& model) {
  ready_ = false;
  qpos_.resize(model.nq);
  unit_qpos_.resize(model.nq);
  qvel_.resize(model.nv);
  eq_data_.resize(mjNEQDATA * model.neq);
  eq_active_.resize(model.neq);
  gravity_.resize(3);
}

bool StepPreparation::isFor(const mjModel& model, const mjData& data) const noexcept {
  return ready_ && same(qpos_, data.qpos) && same(qvel_, data.qvel) &&
         same(eq_data_, model.eq_data) && same(eq_active_, model.eq_active) &&
         same(gravity_, model.opt.gravity);
}

void StepPreparation::prepare(const mjModel& model, mjData* data) noexcept {
  if (isFor(model, *data)) {
    return;
  }
  keep(qpos_, data->qpos);
  keep(qvel_, data->qvel);
  keep(eq_data_, model.eq_data);
  keep(eq_active_, model.eq_active);
  keep(gravity_, model.opt.gravity);
  mj_step1(&model, data);
  // Until the step is taken nobody is to see that it was prepared.
  keep(unit_qpos_, data->qpos);
  std::copy(qpos_.begin(), qpos_.end(), data->qpos);
  ready_ = true;
}

void StepPreparation::step(const mjModel& model, mjData* data) noexcept {
  if (isFor(model, *data)) {
    std::copy(unit_qpos_.begin(), unit_qpos_.end(), data->qpos);
    mj_step2(&model, data);
  } else {
    mj_step(&model, data);
  }
  ready_ = false;
}

}  // namespace franka_sim_mujoco::physics
