// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/scene.h>
#include <mujoco/mujoco.h>

#include <string>

#include "physics/engine/model_data.h"

namespace franka_sim::physics {

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
