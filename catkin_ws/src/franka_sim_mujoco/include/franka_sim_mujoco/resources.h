// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// The file that a package://, model:// or file:// URI (or a plain path) names; empty when unknown.
/// Models are looked for where gazeboModelFolders says, then as files of packages. Any thread.
std::string resolveUri(const std::string& uri);

/// Where Gazebo's models are: in the folders of GAZEBO_MODEL_PATH, then in those that packages
/// export with <gazebo_ros gazebo_model_path="..."/>. Any thread; packages are searched once.
std::vector<std::string> gazeboModelFolders();

/// Where Gazebo's worlds are: GAZEBO_RESOURCE_PATH, then the packages' gazebo_resource_path and
/// gazebo_media_path. As above.
std::vector<std::string> gazeboResourceFolders();

/// What packages export as plugin_path: folders with plugins of Gazebo, which nobody can load here.
std::vector<std::string> gazeboPluginFolders();

}  // namespace franka_sim_mujoco
