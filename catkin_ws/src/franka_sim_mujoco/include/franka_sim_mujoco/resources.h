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

}  // namespace franka_sim_mujoco
