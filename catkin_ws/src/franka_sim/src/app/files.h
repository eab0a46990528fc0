// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace franka_sim {

/// The text of a file. @throws std::runtime_error if it cannot be read.
std::string readFile(const std::string& name);

/// A file of a package of this workspace. Found if this program runs from the install space
/// (../../share/<package>), from the build, or from another folder. Empty if there is none.
std::string packageFile(const std::string& package, const std::string& file);

/// Converts `package://name/path` and `file://` to file names; empty if unknown.
std::string resolveUri(const std::string& uri);

}  // namespace franka_sim
