// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/pictures/scene_model.h"

#include <algorithm>

#include "physics/engine/model_compiler.h"
#include "physics/engine/model_lights.h"
#include "physics/meshes/mesh_simplification.h"

namespace franka_sim::physics {

namespace {

void setJoint(const mjModel& model, mjData* data, const std::string& name, double position) {
  const int joint = mj_name2id(&model, mjOBJ_JOINT, name.c_str());
  if (joint >= 0) {
    data->qpos[model.jnt_qposadr[joint]] = position;
  }
}

void setBody(const mjModel& model, mjData* data, const std::string& name, const Pose& pose) {
  const int body = mj_name2id(&model, mjOBJ_BODY, name.c_str());
  if (body >= 0 && model.body_jntnum[body] > 0 &&
      model.jnt_type[model.body_jntadr[body]] == mjJNT_FREE) {
    double* qpos = data->qpos + model.jnt_qposadr[model.body_jntadr[body]];
    std::copy(pose.position.begin(), pose.position.end(), qpos);
    std::copy(pose.orientation.begin(), pose.orientation.end(), qpos + 3);
  }
}

}  // namespace

bool SceneModel::load(const std::string& mjcf) {
  if (model_ != nullptr && mjcf == mjcf_) {
    return false;
  }
  model_ = compile(mjcf, "The model to draw");
  simplifyDrawnMeshes(model_.get());
  data_ = makeData(*model_);
  mjcf_ = mjcf;
  return true;
}

void SceneModel::pose(const Scene& scene) {
  mj_resetData(model_.get(), data_.get());
  for (const auto& [name, position] : scene.joints) {
    setJoint(*model_, data_.get(), name, position);
  }
  for (const auto& [name, pose] : scene.bodies) {
    setBody(*model_, data_.get(), name, pose);
  }
  for (int l = 0; l < std::min<int>(model_->nlight, scene.lights.size()); ++l) {
    writeLight(model_.get(), l, scene.lights[l]);
  }
  mj_kinematics(model_.get(), data_.get());
  mj_camlight(model_.get(), data_.get());
}

}  // namespace franka_sim::physics
