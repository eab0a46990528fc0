// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world_cameras.h>

#include <cmath>

#include "physics/world/world_impl.h"

namespace franka_sim {

std::vector<WorldCamera> cameras(const World& world) {
  std::vector<WorldCamera> result;
  const mjModel& model = *implOf(world).model;
  for (int c = 0; c < model.ncam; ++c) {
    const char* name = mj_id2name(&model, mjOBJ_CAMERA, c);
    if (name == nullptr) {
      continue;
    }
    WorldCamera camera;
    camera.name = name;
    camera.field_of_view = model.cam_fovy[c];
    if (model.nuser_cam >= 3) {
      const double* user = model.cam_user + c * model.nuser_cam;
      const auto whole = [](double value, int fallback) {
        return value >= 1 && value <= 4096 ? static_cast<int>(std::lround(value)) : fallback;
      };
      camera.width = whole(user[0], camera.width);
      camera.height = whole(user[1], camera.height);
      camera.rate = user[2] > 0 ? user[2] : camera.rate;
    }
    result.push_back(camera);
  }
  return result;
}

}  // namespace franka_sim
