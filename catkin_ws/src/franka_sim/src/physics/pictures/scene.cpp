// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/scene.h>

#include "physics/engine/model_lights.h"
#include "physics/world/world_impl.h"

namespace franka_sim {

Scene captureScene(World& world) {
  World::Impl& impl = implOf(world);
  if (impl.visual_mjcf.empty()) {
    impl.visual_mjcf = world.mjcf(true);
  }
  Scene scene;
  scene.mjcf = impl.visual_mjcf;
  scene.contacts = contacts(world);
  scene.time = world.time();
  scene.fault = world.fault();
  const mjModel& model = *impl.model;
  for (int l = 0; l < model.nlight; ++l) {
    scene.lights.push_back(physics::readLight(model, l));
  }
  for (int j = 0; j < model.njnt; ++j) {
    const double* qpos = impl.data->qpos + model.jnt_qposadr[j];
    if (model.jnt_type[j] == mjJNT_FREE) {
      const char* body = mj_id2name(&model, mjOBJ_BODY, model.jnt_bodyid[j]);
      scene.bodies[body != nullptr ? body : ""] = {{qpos[0], qpos[1], qpos[2]},
                                                   {qpos[3], qpos[4], qpos[5], qpos[6]}};
    } else if (model.jnt_type[j] != mjJNT_BALL) {
      const char* name = mj_id2name(&model, mjOBJ_JOINT, j);
      scene.joints[name != nullptr ? name : ""] = *qpos;
    }
  }
  return scene;
}

}  // namespace franka_sim
