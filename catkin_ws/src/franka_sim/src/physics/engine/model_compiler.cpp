// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/engine/model_compiler.h"

#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <stdexcept>

#include "physics/engine/engine_error.h"
#include "physics/engine/file_registry.h"

namespace franka_sim::physics {

namespace {

constexpr const char* kFileName = "merged.xml";

/// Files in memory that a text may refer to.
class Files {
 public:
  Files() { mj_defaultVFS(files_.get()); }
  ~Files() { mj_deleteVFS(files_.get()); }
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  mjVFS* get() { return files_.get(); }

 private:
  /// The struct contains a table of two thousand file names: too large for a stack.
  std::unique_ptr<mjVFS> files_{new mjVFS};
};

}  // namespace

ModelPtr compile(const std::string& mjcf, const std::string& what) {
  installEngineHandlers();
  const EngineErrorScope scope;
  Files files;
  if (mj_makeEmptyFileVFS(files.get(), kFileName, static_cast<int>(mjcf.size())) != 0) {
    throw std::runtime_error(what + ": there is not enough memory to compile it.");
  }
  std::memcpy(files.get()->filedata[mj_findFileVFS(files.get(), kFileName)], mjcf.data(),
              mjcf.size());
  try {
    addRegisteredFiles(mjcf, files.get());
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(what + ": " + error.what());
  }
  char error[1000] = "";
  ModelPtr model(mj_loadXML(kFileName, files.get(), error, sizeof error));
  if (!model) {
    throw std::runtime_error(what + ": MuJoCo refuses it: " + error);
  }
  return model;
}

}  // namespace franka_sim::physics
