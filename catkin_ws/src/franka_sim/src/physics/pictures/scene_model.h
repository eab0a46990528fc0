// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/scene.h>
#include <franka_sim/physics/world_lights.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "physics/mjcf/model_compiler.h"
#include "physics/mjcf/robot_model.h"

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

/// What two models must have in common so that a state of one is a state of the other: the sizes of
/// all arrays, and a hash of their content as compiled, with the friction and the torque sensors of
/// the robots, which are not part of a model.
struct ModelIdentity {
  std::vector<unsigned char> sizes;
  std::uint64_t content{0};

  bool operator==(const ModelIdentity& other) const noexcept {
    return sizes == other.sizes && content == other.content;
  }
};

/// Call before anything changes the model. Allocates. @param robots of the model
ModelIdentity identityOf(const mjModel& model, const std::vector<const RobotModel*>& robots);

/// A number that no other call in this process has returned. Thread-safe.
std::uint64_t uniqueModelNumber() noexcept;

/// The model that is drawn: compiled from a scene's text, posed as in the scene. One thread owns
/// it.
class SceneModel {
 public:
  /// Compiles if the text differs from the last one. @returns whether it did
  /// @throws std::runtime_error with a sentence when the text does not compile
  bool load(const std::string& mjcf);
  /// Poses joints, free bodies and lights as in the scene, all others at their start.
  void pose(const Scene& scene);

  mjModel* model() noexcept { return model_.get(); }
  const mjModel* model() const noexcept { return model_.get(); }
  mjData* data() noexcept { return data_.get(); }
  const mjData* data() const noexcept { return data_.get(); }

 private:
  std::string mjcf_;
  ModelPtr model_;
  DataPtr data_;
};

}  // namespace franka_sim::physics
