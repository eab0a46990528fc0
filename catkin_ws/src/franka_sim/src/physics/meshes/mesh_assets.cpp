// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/meshes/mesh_assets.h"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>

#include "physics/meshes/mesh_conversion.h"
#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {

namespace {

constexpr std::uint32_t kMaxFaces = 200000;  ///< MuJoCo's own limit for STL

bool isFile(const std::string& path) {
  struct stat info{};
  return stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

std::string lowerExtension(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  if (dot == std::string::npos || path[dot] == '/') {
    return {};
  }
  std::string extension = path.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

/// MuJoCo reads binary STL files only.
bool isBinaryStl(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::int64_t>(file.tellg());
  char header[84];
  file.seekg(0);
  if (size < 84 || !file.read(header, sizeof header)) {
    return false;
  }
  std::uint32_t faces = 0;
  std::memcpy(&faces, header + 80, sizeof faces);
  return faces > 0 && faces <= kMaxFaces && size == 84 + 50 * static_cast<std::int64_t>(faces);
}

/// Whether MuJoCo reads the file directly, which is faster than a conversion.
bool isReady(const std::string& path) {
  const std::string extension = lowerExtension(path);
  return extension == "obj" || (extension == "stl" && isBinaryStl(path));
}

/// `.../meshes/visual/x.dae` -> `.../meshes/mujoco/visual/x/`; empty when not below `meshes`.
std::string convertedFolder(const std::string& path) {
  static const std::string kMeshes = "/meshes/";
  const std::size_t at = path.rfind(kMeshes);
  if (at == std::string::npos) {
    return {};
  }
  const std::size_t rest = at + kMeshes.size();
  return path.substr(0, rest) + "mujoco/" + path.substr(rest, path.rfind('.') - rest) + "/";
}

/// Value after `key` and a colon, up to one of `stops`; leading quotes and brackets are skipped.
std::string valueAfter(const std::string& line, const std::string& key, const char* stops) {
  const std::size_t at = line.find(key);
  const std::size_t colon = at == std::string::npos ? at : line.find(':', at);
  const std::size_t begin =
      colon == std::string::npos ? colon : line.find_first_not_of(" \t\"'[:", colon);
  return begin == std::string::npos ? std::string()
                                    : line.substr(begin, line.find_first_of(stops, begin) - begin);
}

/// The installer writes one line per part: `- {file: 0.obj, rgba: [r, g, b, a]}`. Empty if a part
/// cannot be read: half a link would look broken.
std::vector<MeshPart> readIndex(const std::string& folder) {
  std::ifstream file(folder + "index.yaml");
  std::vector<MeshPart> parts;
  for (std::string line; std::getline(file, line);) {
    const std::string name = valueAfter(line, "file", ",\"'}");
    if (name.empty()) {
      continue;
    }
    MeshPart part{folder + name, std::nullopt};
    std::string color = valueAfter(line, "rgba", "]}");
    std::replace(color.begin(), color.end(), ',', ' ');
    const auto rgba = toNumbers(color, "Color of " + part.file);
    if (rgba.size() == 4) {
      part.rgba = {rgba[0], rgba[1], rgba[2], rgba[3]};
    }
    if (!isFile(part.file) || !isReady(part.file)) {
      return {};
    }
    parts.push_back(part);
  }
  return parts;
}

}  // namespace

std::vector<MeshPart> visualParts(const std::string& uri, const ResourceResolver& resolve) {
  const std::string path = resolve ? resolve(uri) : std::string();
  if (path.empty()) {
    return {};
  }
  const std::string folder = convertedFolder(path);
  const std::vector<MeshPart> parts = folder.empty() ? std::vector<MeshPart>() : readIndex(folder);
  if (!parts.empty() || !isFile(path)) {
    return parts;
  }
  if (isReady(path)) {
    return {{path, std::nullopt}};
  }
  try {
    return loadMeshToDraw({path}).parts;
  } catch (const std::runtime_error&) {
    return {};
  }
}

std::string collisionFile(const std::string& uri, const ResourceResolver& resolve,
                          const std::string& where) {
  const std::string path = resolve ? resolve(uri) : std::string();
  if (path.empty() || !isFile(path)) {
    throw std::runtime_error(where + ": the collision mesh '" + uri + "' " +
                             (path.empty() ? std::string("cannot be resolved to a file")
                                           : "does not exist (searched for " + path + ")") +
                             "; install the meshes or make the URDF without them.");
  }
  if (isReady(path)) {
    return path;
  }
  try {
    return loadMeshToCollide({path}).file;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(where + ": " + error.what() + ".");
  }
}

}  // namespace franka_sim::physics
