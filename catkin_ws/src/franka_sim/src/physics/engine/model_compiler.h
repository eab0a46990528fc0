// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "physics/engine/model_data.h"

namespace franka_sim::physics {

/// Compiles an MJCF text whose files are all named by absolute paths.
/// @param what names the text in errors, e.g. "World file /tmp/x.xml".
/// @throws std::runtime_error "<what>: MuJoCo refuses it: ...".
ModelPtr compile(const std::string& mjcf, const std::string& what);

}  // namespace franka_sim::physics
