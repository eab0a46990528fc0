// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <memory>

namespace franka_sim::physics {

/// Deletes a model.
struct ModelDeleter {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
};
/// Deletes the state of a model.
struct DataDeleter {
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, ModelDeleter>;
using DataPtr = std::unique_ptr<mjData, DataDeleter>;

/// @throws std::runtime_error when there is not enough memory.
DataPtr makeData(const mjModel& model);
/// mj_copyData, without memory for what no solver of the model reads.
/// @throws std::runtime_error when there is not enough memory.
DataPtr copyData(const mjModel& model, const mjData& data);
void copyData(mjData* to, const mjModel& model, const mjData& data);

}  // namespace franka_sim::physics
