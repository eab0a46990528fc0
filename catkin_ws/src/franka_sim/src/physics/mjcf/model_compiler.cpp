// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/model_compiler.h"

#include <franka_core/fnv_hash.h>
#include <mujoco/mujoco.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>

namespace franka_sim::physics {
namespace {

thread_local int scopes = 0;

/// MuJoCo is C, whose frames an exception passes: they have tables for it, but release nothing. The
/// data's stack is set back by who catches it.
void onError(const char* message) {
  if (scopes > 0) {
    throw EngineError(std::string("MuJoCo has failed: ") + message);
  }
  // After a return, MuJoCo would continue with memory that is not there.
  std::fprintf(stderr, "MuJoCo has failed: %s. The process ends.\n", message);
  std::abort();
}

/// MuJoCo's own handler prints and writes MUJOCO_LOG.TXT into the current folder, from inside the
/// loop.
void ignoreWarning(const char* /*message*/) {}

/// An absolute path below which no real file can exist.
constexpr const char* kPlace = "/dev/null/";

/// Texts are passed between threads (stepping, drawing) and outlive their worlds, so the files must
/// too.
struct Store {
  std::mutex mutex;
  std::map<std::string, std::string> files;
};

Store& store() {
  static Store store;
  return store;
}

std::uint64_t hashOf(const std::string& content) {
  franka_core::FnvHash hash;
  for (const char c : content) {
    hash.addByte(static_cast<std::uint8_t>(c));
  }
  return hash.value();
}

std::set<std::string> namedIn(const std::string& text) {
  std::set<std::string> names;
  for (std::size_t at = text.find(kPlace); at != std::string::npos; at = text.find(kPlace, at)) {
    const std::size_t end = text.find_first_of("\"'", at);
    names.insert(text.substr(at, end - at));
    at = end;
  }
  return names;
}

/// Gives MuJoCo access to the kept files that a text names, while it compiles that text.
/// @throws std::runtime_error with a sentence when there are too many or memory is short
void addRegisteredFiles(const std::string& mjcf, mjVFS* files) {
  Store& kept = store();
  const std::lock_guard<std::mutex> lock(kept.mutex);
  for (const std::string& name : namedIn(mjcf)) {
    const auto found = kept.files.find(name);
    if (found == kept.files.end()) {
      continue;  // MuJoCo reports the missing file
    }
    const std::string& content = found->second;
    if (mj_makeEmptyFileVFS(files, name.c_str(), static_cast<int>(content.size())) != 0) {
      throw std::runtime_error("its meshes are more than " + std::to_string(mjMAXVFS - 1) +
                               " or there is not enough memory for them.");
    }
    std::memcpy(files->filedata[mj_findFileVFS(files, name.c_str())], content.data(),
                content.size());
  }
}

}  // namespace

void installEngineHandlers() noexcept {
  static const bool kInstalled = [] {
    if (mju_user_error == nullptr) {
      mju_user_error = onError;
    }
    mju_user_warning = ignoreWarning;
    return true;
  }();
  static_cast<void>(kInstalled);
}

EngineErrorScope::EngineErrorScope() noexcept { scopes++; }
EngineErrorScope::~EngineErrorScope() { scopes--; }

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

std::string registerFile(const std::string& content, const std::string& extension) {
  Store& kept = store();
  const std::lock_guard<std::mutex> lock(kept.mutex);
  for (std::uint64_t hash = hashOf(content);; ++hash) {
    char number[17];
    std::snprintf(number, sizeof number, "%016llx", static_cast<unsigned long long>(hash));
    const auto [entry, is_new] = kept.files.emplace(kPlace + (number + extension), content);
    if (is_new || entry->second == content) {
      return entry->first;
    }
  }
}

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
