// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace franka_sim {

/// The text of a file. @throws std::runtime_error with a sentence.
std::string readFile(const std::string& name);

/// A file of a package of this workspace, whether this program runs from the install space
/// (../../share/<package>), the build, or elsewhere. Empty if there is none.
std::string packageFile(const std::string& package, const std::string& file);

/// Turns `package://name/path` and `file://` into file names; empty when unknown.
std::string resolveUri(const std::string& uri);

}  // namespace franka_sim
