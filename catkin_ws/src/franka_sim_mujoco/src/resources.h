// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// The file of a package://, model:// or file:// URI (or a plain path); empty when unknown. Models
/// are searched in gazeboModelFolders, then in packages. Thread-safe.
std::string resolveUri(const std::string& uri);

/// Folders of Gazebo's models: those of GAZEBO_MODEL_PATH, then those that packages export with
/// <gazebo_ros gazebo_model_path="..."/>. Packages are searched once. Thread-safe.
std::vector<std::string> gazeboModelFolders();

/// Folders of Gazebo's worlds: GAZEBO_RESOURCE_PATH, then the packages' gazebo_resource_path and
/// gazebo_media_path. As above.
std::vector<std::string> gazeboResourceFolders();

/// Folders that packages export as plugin_path: plugins of Gazebo, which cannot be loaded here.
std::vector<std::string> gazeboPluginFolders();

/// Finds a world's file: a path to an MJCF or SDF file, the name of a file in one of `folders`, or
/// the name of an MJCF world there ("stone", "worlds/empty.world"). For a missing path the .xml of
/// the same base name is taken, beside it or in one of `folders`. An empty name gives an empty
/// path: the empty world.
/// @throws std::runtime_error with a sentence if there is none.
std::string findWorldFile(const std::string& name, const std::vector<std::string>& folders);

}  // namespace franka_sim_mujoco
