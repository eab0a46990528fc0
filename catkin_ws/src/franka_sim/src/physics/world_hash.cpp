// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fnv_hash.h>

#include <cstring>

#include "physics/world_impl.h"

namespace franka_sim {
namespace {

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
  for (const Push& push : pushes) {
    hash.add(push.ticks_left);
    hash.add(push.force.data(), 3);
    hash.add(push.torque.data(), 3);
    hash.add(push.point.data(), 3);
  }
  return hash.value();
}

}  // namespace franka_sim
