// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "files.h"

#include <franka_sim/physics/resource_uri.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace franka_sim {

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
      programFolder() / "../share" / package,  // install space: bin/franka_sim
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

std::string resolveUri(const std::string& uri) { return fileOfUri(uri, packageFile); }

}  // namespace franka_sim
