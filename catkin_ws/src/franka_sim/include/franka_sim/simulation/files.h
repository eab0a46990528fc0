// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

namespace franka_sim {

/// The text of a file. @throws std::runtime_error if it cannot be read.
std::string readFile(const std::string& name);

/// A file of a package of this workspace: from the install space that this library is part of
/// (../share/<package>), or else from the sources. Empty if there is none.
std::string packageFile(const std::string& package, const std::string& file);

/// The file of a world: a file's name, or the name of one that is installed with franka_sim
/// (stone.xml); empty for the empty world. @throws std::runtime_error if there is none
std::string worldFile(const std::string& name);

/// Returns the path of a package's file, empty if there is none; `file` is relative to the package.
using PackageFinder =
    std::function<std::string(const std::string& package, const std::string& file)>;

/// The path of a file that a robot's or a world's description names: package://NAME/FILE,
/// file:///FILE or a path, which is returned unchanged. @returns empty if the package or its file
/// does not exist.
std::string fileOfUri(const std::string& uri, const PackageFinder& find);

/// Converts `package://name/path`, `model://name` and addresses of files to file names; empty if
/// unknown. Where ROS is (ROS_PACKAGE_PATH is set), its packages are searched too: themselves, and
/// the folders that they export with <gazebo_ros gazebo_model_path="..."/>.
std::string resolveUri(const std::string& uri);

}  // namespace franka_sim
