// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world_lights.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>

namespace franka_sim::physics {

/// A light of a model, in the frame of its MuJoCo body.
inline WorldLight readLight(const mjModel& model, int id) {
  const auto three = [id](const auto* numbers) {
    return std::array<double, 3>{numbers[3 * id], numbers[3 * id + 1], numbers[3 * id + 2]};
  };
  return {model.light_active[id] != 0, model.light_castshadow[id] != 0, three(model.light_diffuse),
          three(model.light_specular), three(model.light_attenuation),  three(model.light_pos),
          three(model.light_dir)};
}

inline void writeLight(mjModel* model, int id, const WorldLight& light) {
  const auto copy = [id](const std::array<double, 3>& values, auto* numbers) {
    std::copy(values.begin(), values.end(), numbers + 3 * id);
  };
  model->light_active[id] = light.on ? 1 : 0;
  model->light_castshadow[id] = light.shadows ? 1 : 0;
  copy(light.diffuse, model->light_diffuse);
  copy(light.specular, model->light_specular);
  copy(light.attenuation, model->light_attenuation);
  copy(light.position, model->light_pos);
  copy(light.direction, model->light_dir);
}

}  // namespace franka_sim::physics
