// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "physics/world_impl.h"

namespace franka_sim {
namespace {

/// FNV-1a over 64-bit words with a final mix: word by word is fast enough for every tick.
class Hash {
 public:
  void add(std::uint64_t word) noexcept {
    state_ ^= word;
    state_ *= 0x100000001b3ULL;
    state_ ^= state_ >> 29;
  }
  void add(const double* values, int count) noexcept {
    for (int i = 0; i < count; ++i) {
      std::uint64_t word;
      std::memcpy(&word, values + i, sizeof word);
      add(word);
    }
  }
  std::uint64_t value() const noexcept { return state_; }

 private:
  std::uint64_t state_{0xcbf29ce484222325ULL};
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
