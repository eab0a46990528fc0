// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <franka_sim/simulation/files.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace franka_sim {

namespace {

std::filesystem::path libraryFolder() {
  Dl_info info;
  return dladdr(reinterpret_cast<const void*>(&readFile), &info) != 0 && info.dli_fname != nullptr
             ? std::filesystem::path(info.dli_fname).parent_path()
             : std::filesystem::path();
}

std::string ifThere(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? path.lexically_normal().string() : std::string();
}

/// The lines that rospack, ROS's search for packages, prints; none without ROS.
std::vector<std::string> rospack(const std::string& arguments) {
  std::vector<std::string> lines;
  if (std::getenv("ROS_PACKAGE_PATH") == nullptr) {
    return lines;
  }
  const std::string command = "rospack " + arguments + " 2>/dev/null";
  const auto close = [](std::FILE* file) { ::pclose(file); };
  const std::unique_ptr<std::FILE, decltype(close)> pipe(::popen(command.c_str(), "re"), close);
  std::string line;
  for (int c = pipe ? std::fgetc(pipe.get()) : EOF; c != EOF; c = std::fgetc(pipe.get())) {
    if (c != '\n') {
      line.push_back(static_cast<char>(c));
    } else {
      lines.push_back(std::exchange(line, {}));
    }
  }
  return lines;
}

/// Folders that packages export to gazebo_ros as gazebo_model_path. Searched once.
const std::vector<std::string>& exportedModelFolders() {
  static const std::vector<std::string> kFolders = [] {
    std::vector<std::string> folders;
    for (const std::string& line : rospack("plugins --attrib=gazebo_model_path gazebo_ros")) {
      const std::size_t space = line.find(' ');  // after the package's name
      std::istringstream list(space == std::string::npos ? "" : line.substr(space + 1));
      for (std::string folder; std::getline(list, folder, ':');) {
        folders.push_back(folder);
      }
    }
    return folders;
  }();
  return kFolders;
}

/// A file of a package of this workspace, or else of any that ROS finds.
std::string anyPackageFile(const std::string& package, const std::string& file) {
  const std::string own = packageFile(package, file);
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  };
  if (!own.empty() || !std::all_of(package.begin(), package.end(), is_plain)) {
    return own;
  }
  const std::vector<std::string> found = rospack("find " + package);
  return found.empty() ? "" : ifThere(std::filesystem::path(found.front()) / file);
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
    const std::string found = ifThere(place / file);
    if (!found.empty()) {
      return found;
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

std::string fileOfUri(const std::string& uri, const PackageFinder& find) {
  static const std::string kPackage = "package://", kFile = "file://";
  if (uri.compare(0, kFile.size(), kFile) == 0) {
    return uri.substr(kFile.size());
  }
  if (uri.compare(0, kPackage.size(), kPackage) != 0) {
    return uri;
  }
  const std::size_t slash = uri.find('/', kPackage.size());
  // Without a file in it: names such as `sun`, which are not packages; rospack would print errors
  // about them.
  if (slash == std::string::npos) {
    return "";
  }
  return find(uri.substr(kPackage.size(), slash - kPackage.size()), uri.substr(slash + 1));
}

std::string resolveUri(const std::string& uri) {
  static const std::string kModel = "model://";
  if (uri.compare(0, kModel.size(), kModel) != 0) {
    return fileOfUri(uri, anyPackageFile);
  }
  for (const std::string& folder : exportedModelFolders()) {
    const std::string found = ifThere(std::filesystem::path(folder) / uri.substr(kModel.size()));
    if (!found.empty()) {
      return found;
    }
  }
  return "";
}

}  // namespace franka_sim
