// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace franka_sim {

/// Returns the path of a package's file, empty if there is none; `file` is relative to the package.
using PackageFinder =
    std::function<std::string(const std::string& package, const std::string& file)>;

/// The path of a file that a robot's or a world's description names: package://NAME/FILE,
/// file:///FILE or a path, which is returned unchanged. @returns empty if the package or its file
/// does not exist.
std::string fileOfUri(const std::string& uri, const PackageFinder& find);

}  // namespace franka_sim
