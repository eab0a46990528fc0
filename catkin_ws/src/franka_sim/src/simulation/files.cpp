// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <franka_sim/physics/resource_uri.h>
#include <franka_sim/simulation/files.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace franka_sim {

namespace {

std::filesystem::path libraryFolder() {
  Dl_info info;
  return dladdr(reinterpret_cast<const void*>(&readFile), &info) != 0 && info.dli_fname != nullptr
             ? std::filesystem::path(info.dli_fname).parent_path()
             : std::filesystem::path();
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
      libraryFolder() / "../share" / package,
#ifdef FRANKA_SIM_SOURCES
      std::filesystem::path(FRANKA_SIM_SOURCES) / package,
#endif
  };
  for (const auto& place : places) {
    std::error_code error;
    const auto found = place / file;
    if (std::filesystem::exists(found, error)) {
      return found.lexically_normal().string();
    }
  }
  return "";
}

std::string worldFile(const std::string& name) {
  std::error_code error;
  if (name.empty() || std::filesystem::exists(name, error)) {
    return name;
  }
  const std::string file = packageFile("franka_sim", "worlds/" + name);
  if (file.empty()) {
    throw std::runtime_error("There is no world '" + name +
                             "': neither a file nor one of those that come with franka_sim.");
  }
  return file;
}

std::string resolveUri(const std::string& uri) { return fileOfUri(uri, packageFile); }

}  // namespace franka_sim
