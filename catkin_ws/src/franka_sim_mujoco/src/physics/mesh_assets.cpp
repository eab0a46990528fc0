// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mesh_assets.h"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "physics/xml_util.h"

namespace franka_sim_mujoco::physics {
namespace {

constexpr std::uint32_t kMostFaces = 200000;  ///< MuJoCo's own limit for STL

bool isFile(const std::string& path) {
  struct stat info {};
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

/// Empty when fine, else what is wrong with an STL file: MuJoCo reads binary ones only.
std::string stlProblem(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const auto size = static_cast<std::int64_t>(file.tellg());
  char header[84];
  file.seekg(0);
  if (size < 84 || !file.read(header, sizeof header)) {
    return "it is too short for a binary STL file";
  }
  std::uint32_t faces = 0;
  std::memcpy(&faces, header + 80, sizeof faces);
  if (size != 84 + 50 * static_cast<std::int64_t>(faces)) {
    return "it is no binary STL file (ASCII STL cannot be read) or it is cut off";
  }
  if (faces == 0 || faces > kMostFaces) {
    return "it has " + std::to_string(faces) + " faces; 1 to " + std::to_string(kMostFaces) +
           " can be read";
  }
  return {};
}

std::string meshProblem(const std::string& path) {
  const std::string extension = lowerExtension(path);
  if (extension == "stl") {
    return stlProblem(path);
  }
  return extension == "obj" ? std::string() : "only binary STL and OBJ files can be read";
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

/// Value after `key` and a colon; quotes, JSON and YAML punctuation around it do not matter.
std::string valueAfter(const std::string& text, const std::string& key, std::size_t from,
                       std::size_t* end) {
  const std::size_t at = text.find(key, from);
  if (at == std::string::npos) {
    return {};
  }
  std::size_t begin = text.find(':', at + key.size());
  begin = text.find_first_not_of(" \t\r\n\"'[:", begin);
  *end = begin == std::string::npos ? begin : text.find_first_of("\"'\r\n]}", begin);
  if (*end == std::string::npos) {
    return {};
  }
  return text.substr(begin, *end - begin);
}

/// The installer writes, for each part, `file` and then `rgba`.
std::vector<MeshPart> readIndex(const std::string& folder) {
  std::ifstream file(folder + "index.yaml");
  if (!file) {
    file.open(folder + "index.json");
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<MeshPart> parts;
  std::size_t at = text.find("file", 0);
  while (at != std::string::npos) {
    std::size_t end = at;
    MeshPart part;
    std::string name = valueAfter(text, "file", at, &end);
    name = name.substr(0, name.find(','));
    part.file = folder + name;
    std::size_t colour_end = end;
    std::string colour = end == std::string::npos ? "" : valueAfter(text, "rgba", end, &colour_end);
    std::replace(colour.begin(), colour.end(), ',', ' ');
    const auto rgba = toNumbers(colour, "Colour in " + folder);
    if (rgba.size() == 4) {
      part.rgba = {rgba[0], rgba[1], rgba[2], rgba[3]};
    }
    if (!isFile(part.file) || !meshProblem(part.file).empty()) {
      return {};
    }
    parts.push_back(part);
    at = end == std::string::npos ? end : text.find("file", end);
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
  std::vector<MeshPart> parts = folder.empty() ? std::vector<MeshPart>() : readIndex(folder);
  if (parts.empty() && isFile(path) && meshProblem(path).empty()) {
    parts.push_back({path, std::nullopt});
  }
  return parts;
}

std::string collisionFile(const std::string& uri, const ResourceResolver& resolve,
                          const std::string& where) {
  const std::string path = resolve ? resolve(uri) : std::string();
  if (path.empty() || !isFile(path)) {
    throw std::runtime_error(where + ": the collision mesh '" + uri + "' " +
                             (path.empty() ? std::string("cannot be resolved to a file")
                                           : "is not there (looked for " + path + ")") +
                             "; install the meshes or make the URDF without them.");
  }
  const std::string problem = meshProblem(path);
  if (!problem.empty()) {
    throw std::runtime_error(where + ": the collision mesh " + path + " cannot be used: " +
                             problem + ".");
  }
  return path;
}

}  // namespace franka_sim_mujoco::physics
