// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace franka_sim::physics {

/// What MuJoCo cannot do: too little memory for its stack, data of another model, no graphics.
class EngineError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Installs the handlers of MuJoCo's errors and warnings, once in a process. MuJoCo's own handler
/// of errors prints, waits for the Enter key and ends the process. A handler that the program has
/// installed already stays.
void installEngineHandlers() noexcept;

/// Within its life, an error of MuJoCo in this thread throws EngineError out of the function of
/// MuJoCo, whose results are then not usable. Without one, an error prints its sentence and aborts
/// the process. May be nested. Real-time safe. Exception: an error.
class EngineErrorScope {
 public:
  EngineErrorScope() noexcept;
  ~EngineErrorScope();
  EngineErrorScope(const EngineErrorScope&) = delete;
  EngineErrorScope& operator=(const EngineErrorScope&) = delete;
};

struct ModelDeleter {
  void operator()(mjModel* model) const noexcept { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const noexcept { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, ModelDeleter>;
using DataPtr = std::unique_ptr<mjData, DataDeleter>;

/// Keeps a file's content in memory until the process ends and returns the name for MJCF texts. The
/// same content is stored once and always has the same name. Thread-safe.
/// @param extension with its dot, e.g. ".msh": MuJoCo derives the file's kind from it
std::string registerFile(const std::string& content, const std::string& extension);

/// Compiles an MJCF text whose files are all named by absolute paths.
/// @param what names the text in errors, e.g. "World file /tmp/x.xml".
/// @throws std::runtime_error "<what>: MuJoCo refuses it: ...".
ModelPtr compile(const std::string& mjcf, const std::string& what);
/// @throws std::runtime_error when there is not enough memory.
DataPtr makeData(const mjModel& model);
/// mj_copyData, without memory for what no solver of the model reads.
/// @throws std::runtime_error when there is not enough memory.
DataPtr copyData(const mjModel& model, const mjData& data);
void copyData(mjData* to, const mjModel& model, const mjData& data);

}  // namespace franka_sim::physics
