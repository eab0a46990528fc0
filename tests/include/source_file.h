// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace franka_test {

/// The path of a file in catkin_ws/src, for example "franka_sim/robots/panda.urdf".
std::string sourceFile(const std::string& path);

/// Its text. @throws std::runtime_error if it cannot be read
std::string readSource(const std::string& path);

}  // namespace franka_test
