// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <vector>

#include "physics/mjcf/robot_model.h"

namespace franka_sim::physics {

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

}  // namespace franka_sim::physics
