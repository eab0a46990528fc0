// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/engine/model_identity.h"

#include <franka_core/fnv_hash.h>

#include <atomic>
#include <cstddef>
#include <cstring>

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

}  // namespace franka_sim::physics
