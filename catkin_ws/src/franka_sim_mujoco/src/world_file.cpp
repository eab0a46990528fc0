// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/world_file.h>

#include <filesystem>
#include <stdexcept>

namespace franka_sim_mujoco {

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
