// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "resources.h"

#include <franka_sim/simulation/robot_setup.h>
#include <ros/package.h>

#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <sstream>
#include <stdexcept>

namespace franka_sim_mujoco {

namespace {

using Folders = std::vector<std::string>;

void appendList(const std::string& list, Folders& folders) {
  std::istringstream parts(list);
  for (std::string folder; std::getline(parts, folder, ':');) {
    if (!folder.empty()) {
      folders.push_back(folder);
    }
  }
}

/// Folders that packages which depend on gazebo_ros export under these attributes.
Folders exportedFolders(std::initializer_list<const char*> attributes) {
  Folders folders;
  for (const char* attribute : attributes) {
    Folders lists;
    ros::package::getPlugins("gazebo_ros", attribute, lists);
    for (const std::string& list : lists) {
      appendList(list, folders);
    }
  }
  return folders;
}

Folders withVariable(const char* variable, const Folders& exported) {
  Folders folders;
  const char* value = std::getenv(variable);
  appendList(value != nullptr ? value : "", folders);
  folders.insert(folders.end(), exported.begin(), exported.end());
  return folders;
}

std::string packageFile(const std::string& package, const std::string& file) {
  const std::string folder = ros::package::getPath(package);
  return folder.empty() ? folder : folder + "/" + file;
}

}  // namespace

std::string resolveUri(const std::string& uri) {
  static const std::string kModel = "model://";
  if (uri.compare(0, kModel.size(), kModel) != 0) {
    return franka_sim::fileOfUri(uri, packageFile);
  }
  const std::string name = uri.substr(kModel.size());
  for (const std::string& folder : gazeboModelFolders()) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::error_code error;
    if (std::filesystem::exists(file, error)) {
      return file.string();
    }
  }
  return franka_sim::fileOfUri("package://" + name, packageFile);
}

Folders gazeboModelFolders() {
  static const Folders kExported = exportedFolders({"gazebo_model_path"});
  return withVariable("GAZEBO_MODEL_PATH", kExported);
}

Folders gazeboResourceFolders() {
  static const Folders kExported = exportedFolders({"gazebo_resource_path", "gazebo_media_path"});
  return withVariable("GAZEBO_RESOURCE_PATH", kExported);
}

Folders gazeboPluginFolders() {
  static const Folders kExported = exportedFolders({"plugin_path"});
  return kExported;
}

namespace {

namespace fs = std::filesystem;

bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

}  // namespace

std::string findWorldFile(const std::string& name, const std::vector<std::string>& folders) {
  if (name.empty()) {
    return "";
  }
  const fs::path given(name);
  if (isFile(given)) {
    return given.string();
  }
  fs::path mjcf = given;
  mjcf.replace_extension(".xml");
  if (given.has_parent_path() && isFile(mjcf)) {
    return mjcf.string();
  }
  std::string searched;
  for (const std::string& folder : folders) {
    for (const fs::path& name_there : {given, mjcf.filename()}) {
      const fs::path candidate = fs::path(folder) / name_there;
      if (isFile(candidate)) {
        return candidate.string();
      }
    }
    searched += (searched.empty() ? "" : ", ") + folder;
  }
  throw std::runtime_error(
      "The world '" + name + "' was not found: there is no such file, and neither it nor a " +
      mjcf.filename().string() + " in " + searched +
      ". Give the path of an MJCF or SDF file or the name of a world that is there.");
}

}  // namespace franka_sim_mujoco
