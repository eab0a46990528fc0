// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <string>

namespace franka_sim::physics {

/// Keeps a file's content in memory until the process ends and returns the name under which MJCF
/// texts may use it. The same content is kept once and always has the same name. Any thread.
/// @param extension with its dot, e.g. ".msh": MuJoCo tells the kind of a file by it
std::string keepFile(const std::string& content, const std::string& extension);

/// Puts the kept files that a text names where MuJoCo finds them while it compiles that text.
/// @throws std::runtime_error with a sentence when there are too many or memory is short
void lendKeptFiles(const std::string& mjcf, mjVFS* files);

}  // namespace franka_sim::physics
