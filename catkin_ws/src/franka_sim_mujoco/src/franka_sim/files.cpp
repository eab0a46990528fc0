// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "files.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace franka_sim_mujoco {

namespace {

std::filesystem::path programFolder() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path() : program.parent_path();
}

}  // namespace

std::string readFile(const std::string& name) {
  std::ifstream file(name);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    throw std::runtime_error("Cannot read the file '" + name + "'.");
  }
  return text.str();
}

std::string packageFile(const std::string& package, const std::string& file) {
  const std::filesystem::path places[] = {
      programFolder() / "../../share" / package,  // install space: lib/<package>/program
      std::filesystem::path(FRANKA_SIM_SOURCES) / package};
  for (const auto& place : places) {
    std::error_code error;
    const auto found = place / file;
    if (std::filesystem::exists(found, error)) {
      return found.lexically_normal().string();
    }
  }
  return "";
}

std::string resolveUri(const std::string& uri) {
  static const std::string kPackage = "package://", kFile = "file://";
  if (uri.compare(0, kFile.size(), kFile) == 0) {
    return uri.substr(kFile.size());
  }
  if (uri.compare(0, kPackage.size(), kPackage) != 0) {
    return uri;
  }
  const std::size_t slash = uri.find('/', kPackage.size());
  if (slash == std::string::npos) {
    return "";
  }
  return packageFile(uri.substr(kPackage.size(), slash - kPackage.size()), uri.substr(slash + 1));
}

}  // namespace franka_sim_mujoco
