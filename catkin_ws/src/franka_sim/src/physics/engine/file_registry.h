// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <string>

namespace franka_sim::physics {

/// Keeps a file's content in memory until the process ends and returns the name for MJCF texts. The
/// same content is stored once and always has the same name. Thread-safe.
/// @param extension with its dot, e.g. ".msh": MuJoCo derives the file's kind from it
std::string registerFile(const std::string& content, const std::string& extension);

/// Gives MuJoCo access to the kept files that a text names, while it compiles that text.
/// @throws std::runtime_error with a sentence when there are too many or memory is short
void addRegisteredFiles(const std::string& mjcf, mjVFS* files);

}  // namespace franka_sim::physics
