// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/meshes/mesh_assets.h"

#include <meshoptimizer.h>
#include <sys/stat.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

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

namespace {

using Vertex = Eigen::Vector3f;
using Index = unsigned int;

// Chosen here: less than a pixel of a camera with 640 of them at 0.3 m; and a share of the size of
// a mesh, for small ones.
constexpr float kError = 3e-4F;  // [m]
constexpr float kShare = 5e-3F;
constexpr float kCosineOfAnEdge = 0.866F;  // 30 degrees
constexpr int kFewFaces = 100;             // are not simplified

/// A mesh in MuJoCo's arrays.
struct Mesh {
  float* vertices;
  float* normals;
  int* faces;  ///< of the mesh's own vertices
  std::size_t vertex_count;
  std::size_t face_count;
};

/// Vertices at different places, and three of them for each face.
struct Surface {
  std::vector<Vertex> vertices;
  std::vector<Index> corners;
};

/// MuJoCo gives each face vertices of its own.
Surface weld(const Mesh& mesh) {
  std::vector<Index> place(mesh.vertex_count);
  Surface surface;
  surface.vertices.resize(meshopt_generateVertexRemap<Index>(
      place.data(), nullptr, mesh.vertex_count, mesh.vertices, mesh.vertex_count, sizeof(Vertex)));
  for (std::size_t i = 0; i < mesh.vertex_count; ++i) {
    surface.vertices[place[i]] = Vertex::Map(mesh.vertices + 3 * i);
  }
  for (std::size_t i = 0; i < 3 * mesh.face_count; ++i) {
    surface.corners.push_back(place[static_cast<std::size_t>(mesh.faces[i])]);
  }
  return surface;
}

float sizeOf(const Surface& surface) {
  return meshopt_simplifyScale(surface.vertices.front().data(), surface.vertices.size(),
                               sizeof(Vertex));
}

/// @param error as a share of the size
void simplify(Surface* surface, float error) {
  std::vector<Index> left(surface->corners.size());
  left.resize(meshopt_simplify(left.data(), surface->corners.data(), left.size(),
                               surface->vertices.front().data(), surface->vertices.size(),
                               sizeof(Vertex), 0, error, 0, nullptr));
  surface->corners = std::move(left);
}

/// Twice the area of each face, along its normal. Faces whose height is below the error [m] have
/// no reliable normal: their area is zero.
std::vector<Vertex> areasOf(const Surface& surface, float error) {
  std::vector<Vertex> areas;
  for (std::size_t i = 0; i < surface.corners.size(); i += 3) {
    const auto edge = [&](std::size_t from, std::size_t to) -> Vertex {
      return surface.vertices[surface.corners[i + to]] -
             surface.vertices[surface.corners[i + from]];
    };
    const Vertex area = edge(0, 1).cross(edge(0, 2));
    const float longest = std::max({edge(0, 1).norm(), edge(1, 2).norm(), edge(2, 0).norm()});
    areas.emplace_back(area.norm() > error * longest ? area : Vertex::Zero());
  }
  return areas;
}

std::vector<std::vector<std::size_t>> facesAtVertices(const Surface& surface) {
  std::vector<std::vector<std::size_t>> faces(surface.vertices.size());
  for (std::size_t i = 0; i < surface.corners.size(); ++i) {
    faces[surface.corners[i]].push_back(i / 3);
  }
  return faces;
}

/// @param areas of the faces at the vertex
/// @param area of the face to shade; zero: as the largest face at the vertex
Vertex normalAt(const std::vector<Vertex>& areas, const Vertex& area) {
  const auto smaller = [](const Vertex& a, const Vertex& b) { return a.norm() < b.norm(); };
  const Vertex like =
      area.isZero(0.0F) ? *std::max_element(areas.begin(), areas.end(), smaller) : area;
  Vertex sum = Vertex::Zero();
  for (const Vertex& other : areas) {
    if (like.dot(other) >= kCosineOfAnEdge * like.norm() * other.norm()) {
      sum += other;
    }
  }
  return sum.normalized();
}

/// Writes a surface, which has at most as many faces as the mesh had, with normals.
void write(const Surface& surface, const std::vector<Vertex>& areas, const Mesh& mesh) {
  const std::vector<std::vector<std::size_t>> faces = facesAtVertices(surface);
  for (std::size_t i = 0; i < surface.corners.size(); ++i) {
    const Index vertex = surface.corners[i];
    std::vector<Vertex> areas_here;
    for (const std::size_t face : faces[vertex]) {
      areas_here.push_back(areas[face]);
    }
    Vertex::Map(mesh.vertices + 3 * i) = surface.vertices[vertex];
    Vertex::Map(mesh.normals + 3 * i) = normalAt(areas_here, areas[i / 3]);
    mesh.faces[i] = static_cast<int>(i);
  }
}

/// @returns the number of faces that are left
int simplifyMesh(const Mesh& mesh) {
  Surface surface = weld(mesh);
  const float size = sizeOf(surface);
  const float error = std::min(kError / size, kShare);
  simplify(&surface, error);
  // Each face gets vertices of its own.
  if (surface.corners.size() > mesh.vertex_count) {
    return static_cast<int>(mesh.face_count);
  }
  write(surface, areasOf(surface, error * size), mesh);
  return static_cast<int>(surface.corners.size() / 3);
}

}  // namespace

void simplifyDrawnMeshes(mjModel* model) {
  for (int i = 0; i < model->nmesh; ++i) {
    const std::ptrdiff_t vertex = 3 * static_cast<std::ptrdiff_t>(model->mesh_vertadr[i]);
    const Mesh mesh{model->mesh_vert + vertex, model->mesh_normal + vertex,
                    model->mesh_face + 3 * static_cast<std::ptrdiff_t>(model->mesh_faceadr[i]),
                    static_cast<std::size_t>(model->mesh_vertnum[i]),
                    static_cast<std::size_t>(model->mesh_facenum[i])};
    if (model->mesh_facenum[i] < kFewFaces || model->mesh_texcoordadr[i] >= 0) {
      continue;
    }
    model->mesh_facenum[i] = simplifyMesh(mesh);
    model->mesh_graphadr[i] = -1;  // the vertices of its hull are gone
  }
}

}  // namespace franka_sim::physics
