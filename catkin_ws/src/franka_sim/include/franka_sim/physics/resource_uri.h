// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace franka_sim {

/// Where a file of a package is, empty if there is none; `file` is relative to the package.
using PackageFinder =
    std::function<std::string(const std::string& package, const std::string& file)>;

/// The file that a robot's or a world's description names: package://NAME/FILE, file:///FILE or a
/// path, which stays as it is. @returns empty where a package is named that is not there, or no
/// file in it.
std::string fileOfUri(const std::string& uri, const PackageFinder& find);

}  // namespace franka_sim
