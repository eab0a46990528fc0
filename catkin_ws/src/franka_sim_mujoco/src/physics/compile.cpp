// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/compile.h"

#include <cstring>
#include <stdexcept>

namespace franka_sim_mujoco::physics {
namespace {

constexpr const char* kFileName = "merged.xml";

/// MuJoCo's own handler prints and writes MUJOCO_LOG.TXT into the current folder, from inside the
/// loop.
void ignoreWarning(const char* /*message*/) {}

}  // namespace

ModelPtr compile(const std::string& mjcf, const std::string& what) {
  mju_user_warning = ignoreWarning;
  // The struct holds a table of two thousand file names: too large for a stack.
  const std::unique_ptr<mjVFS> files(new mjVFS);
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), kFileName, static_cast<int>(mjcf.size())) != 0) {
    throw std::runtime_error(what + ": there is not enough memory to compile it.");
  }
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), kFileName)], mjcf.data(), mjcf.size());
  char error[1000] = "";
  ModelPtr model(mj_loadXML(kFileName, files.get(), error, sizeof error));
  mj_deleteVFS(files.get());
  if (!model) {
    throw std::runtime_error(what + ": MuJoCo refuses it: " + error);
  }
  return model;
}

DataPtr makeData(const mjModel& model) {
  DataPtr data(mj_makeData(&model));
  if (!data) {
    throw std::runtime_error("There is not enough memory for the state of the simulated world.");
  }
  return data;
}

}  // namespace franka_sim_mujoco::physics
