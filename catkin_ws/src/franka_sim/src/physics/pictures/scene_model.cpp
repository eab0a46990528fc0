// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/pictures/scene_model.h"

#include <franka_core/fnv_hash.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>

#include "physics/meshes/mesh_simplification.h"

namespace franka_sim::physics {
namespace {

std::uint64_t hashOf(const void* memory, std::size_t bytes) noexcept {
  franka_core::FnvHash hash;
  const auto* const from = static_cast<const unsigned char*>(memory);
  std::size_t at = 0;
  for (; at + sizeof(std::uint64_t) <= bytes; at += sizeof(std::uint64_t)) {
    std::uint64_t word;
    std::memcpy(&word, from + at, sizeof word);
    hash.addWord(word, 32);
  }
  for (; at < bytes; at++) {
    hash.addByte(from[at]);
  }
  return hash.value();
}

}  // namespace

ModelIdentity identityOf(const mjModel& model, const std::vector<const RobotModel*>& robots) {
  // The sizes stand in front of the options, one after the other.
  const auto* const sizes = reinterpret_cast<const unsigned char*>(&model);
  ModelIdentity identity;
  identity.sizes.assign(sizes, sizes + offsetof(mjModel, opt));
  franka_core::FnvHash content;
  content.addWord(hashOf(model.buffer, static_cast<std::size_t>(model.nbuffer)), 32);
  content.addWord(hashOf(&model.opt, sizeof model.opt), 32);
  for (const RobotModel* robot : robots) {
    for (const auto& [joint, law] : robot->description.friction) {
      content.addWord(hashOf(joint.data(), joint.size()), 32);
      content.addWord(hashOf(&law, sizeof law), 32);
    }
    for (const auto& [joint, offset] : robot->description.torque_offset) {
      content.addWord(hashOf(joint.data(), joint.size()), 32);
      content.addWord(hashOf(&offset, sizeof offset), 32);
    }
  }
  identity.content = content.value();
  return identity;
}

std::uint64_t uniqueModelNumber() noexcept {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

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
