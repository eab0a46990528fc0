// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World: its state: hashed, saved and restored.

#include <franka_core/fnv_hash.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_gravity.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "physics/world/world_impl.h"

namespace franka_sim {
namespace {

/// Restores what plants keep; those that the snapshot does not know are reset.
template <typename Plants, typename States>
void restorePlants(Plants& plants, const States& states) {
  for (auto& [name, plant] : plants) {
    const auto then = states.find(name);
    if (then != states.end()) {
      plant->restore(then->second);
    } else {
      plant->reset();
    }
  }
}

class Hash {
 public:
  void add(std::uint64_t word) noexcept { hash_.addWord(word, 29); }
  void add(const double* values, int count) noexcept {
    for (int i = 0; i < count; ++i) {
      std::uint64_t word;
      std::memcpy(&word, values + i, sizeof word);
      add(word);
    }
  }
  std::uint64_t value() const noexcept { return hash_.value(); }

 private:
  franka_core::FnvHash hash_;
};

}  // namespace

struct Snapshot::Content {
  std::uint64_t generation, ticks;
  physics::ModelIdentity identity;
  physics::DataPtr data;
  physics::MotorSide motor_side;
  physics::JointFrictions frictions;
  physics::RobotClearance::State clearance;
  physics::ObjectRest::State object_rest;
  std::vector<Push> pushes;
  bool contacts_kept, objects_held;
  std::vector<GeomContact> contacts;
  std::vector<double> eq_data;
  std::vector<unsigned char> eq_active;
  std::array<double, 3> gravity;
  std::map<std::string, physics::MujocoArm::State> arms;
  std::map<std::string, physics::MujocoDrive::State> drives;
};

Snapshot World::snapshot() const {
  impl_->requireRuns();
  const mjModel& model = *impl_->model;
  const physics::EngineErrorScope scope;
  auto content = std::make_shared<Snapshot::Content>();
  content->generation = impl_->generation;
  content->identity = impl_->identity;
  content->ticks = impl_->ticks;
  content->data = physics::copyData(model, *impl_->data);
  content->motor_side = impl_->motor_side;
  content->frictions = impl_->frictions;
  content->clearance = impl_->clearance.state();
  content->object_rest = impl_->object_rest.state();
  content->pushes = impl_->pushes;
  content->contacts_kept = impl_->contacts_kept;
  content->objects_held = impl_->objects_held;
  content->contacts = impl_->kept_contacts;
  content->eq_data.assign(model.eq_data, model.eq_data + mjNEQDATA * model.neq);
  content->eq_active.assign(model.eq_active, model.eq_active + model.neq);
  content->gravity = gravity(*this);
  for (const auto& [name, arm] : impl_->arms) {
    content->arms.emplace(name, arm->state());
  }
  for (const auto& [joint, drive] : impl_->drives) {
    content->drives.emplace(joint, drive->state());
  }
  return Snapshot(content);
}

void World::restore(const Snapshot& snapshot) {
  const Snapshot::Content* content = snapshot.content();
  if (content == nullptr ||
      (content->generation != impl_->generation && !(content->identity == impl_->identity))) {
    throw std::runtime_error(
        "The snapshot cannot be restored: it is of another world, or a robot or object came or "
        "went since it was taken. Take another one.");
  }
  mjModel& model = *impl_->model;
  impl_->clearFaults();
  setGravity(*this, content->gravity);
  const physics::EngineErrorScope scope;
  physics::copyData(impl_->data.get(), model, *content->data);
  std::copy(content->eq_data.begin(), content->eq_data.end(), model.eq_data);
  std::copy(content->eq_active.begin(), content->eq_active.end(), model.eq_active);
  impl_->motor_side = content->motor_side;
  impl_->frictions = content->frictions;
  impl_->clearance.restore(content->clearance);
  impl_->object_rest.restore(content->object_rest);
  impl_->pushes = content->pushes;
  impl_->preparation.drop();
  impl_->contacts_kept = content->contacts_kept;
  impl_->objects_held = content->objects_held;
  impl_->kept_contacts = content->contacts;
  impl_->ticks = content->ticks;
  impl_->kinematics_fresh = false;
  restorePlants(impl_->arms, content->arms);
  restorePlants(impl_->drives, content->drives);
}

std::uint64_t World::Impl::hash() const noexcept {
  Hash hash;
  hash.add(ticks);
  hash.add(data->qpos, model->nq);
  hash.add(data->qvel, model->nv);
  hash.add(data->qacc_warmstart, model->nv);
  hash.add(data->qfrc_applied, model->nv);
  hash.add(data->act, model->na);
  hash.add(data->ctrl, model->nu);
  hash.add(data->mocap_pos, 3 * model->nmocap);
  hash.add(data->mocap_quat, 4 * model->nmocap);
  hash.add(motor_side.torques().data(), model->nv);
  for (const physics::JointFrictions::Joint& joint : frictions.joints()) {
    hash.add(&joint.held, 1);
  }
  // Brakes, from the model: an arm that was never requested has none closed.
  for (int e = 0; e < model->neq; ++e) {
    hash.add(static_cast<std::uint64_t>(model->eq_active[e]));
    hash.add(model->eq_data + mjNEQDATA * e, 1);
  }
  for (const auto& [joint, drive] : drives) {
    const DriveLimits& limits = drive->state().limits;
    if (drive->state().follows && std::isfinite(limits.effort)) {
      hash.add(&limits.effort, 1);
      hash.add(&limits.velocity, 1);
    }
  }
  for (const Push& push : pushes) {
    hash.add(push.ticks_left);
    hash.add(push.force.data(), 3);
    hash.add(push.torque.data(), 3);
    hash.add(push.point.data(), 3);
    hash.add(&push.effort, 1);
  }
  return hash.value();
}

}  // namespace franka_sim
