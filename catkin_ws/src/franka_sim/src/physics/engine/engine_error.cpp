// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/engine/engine_error.h"

#include <mujoco/mujoco.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace franka_sim::physics {

namespace {

thread_local int scopes = 0;

/// MuJoCo is C, whose frames an exception passes: they have tables for it, but release nothing. The
/// data's stack is set back by the function that catches it.
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

}  // namespace franka_sim::physics
