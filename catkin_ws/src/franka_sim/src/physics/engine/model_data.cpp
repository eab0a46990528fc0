// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/engine/model_data.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "physics/engine/engine_error.h"

namespace franka_sim::physics {

namespace {

constexpr const char* kNoMemory =
    "There is not enough memory for the state of the simulated world.";

/// Gives the memory of an array, whose content is not needed, back to the system, which provides
/// zeros when it is used again: MuJoCo writes to all of it at first, and most worlds use little.
template <typename T>
void release(T* array, std::size_t count) noexcept {
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(array);
  const std::uintptr_t begin = (address + page - 1) / page * page;
  const std::uintptr_t end = (address + count * sizeof(T)) / page * page;
  if (begin < end) {
    madvise(reinterpret_cast<void*>(begin), end - begin, MADV_DONTNEED);  // NOLINT
  }
}

/// The matrix of the size of all constraints squared is that of MuJoCo's dual solvers.
void releaseDualMatrix(const mjModel& model, mjData* data) noexcept {
  if (model.opt.solver != mjSOL_PGS && model.opt.noslip_iterations == 0) {
    const std::size_t rows = model.njmax;
    release(data->efc_AR, rows * rows);
    release(data->efc_AR_colind, rows * rows);
  }
}

}  // namespace

DataPtr makeData(const mjModel& model) {
  const EngineErrorScope scope;
  DataPtr data(mj_makeData(&model));
  if (!data) {
    throw std::runtime_error(kNoMemory);
  }
  const std::size_t rows = model.njmax, dofs = model.nv;
  release(data->efc_J, rows * dofs);
  release(data->efc_J_colind, rows * dofs);
  release(data->efc_JT, rows * dofs);
  release(data->efc_JT_colind, rows * dofs);
  releaseDualMatrix(model, data.get());
  return data;
}

DataPtr copyData(const mjModel& model, const mjData& data) {
  const EngineErrorScope scope;
  DataPtr copy(mj_copyData(nullptr, &model, &data));
  if (!copy) {
    throw std::runtime_error(kNoMemory);
  }
  releaseDualMatrix(model, copy.get());
  return copy;
}

void copyData(mjData* to, const mjModel& model, const mjData& data) {
  mj_copyData(to, &model, &data);
  releaseDualMatrix(model, to);
}

}  // namespace franka_sim::physics
