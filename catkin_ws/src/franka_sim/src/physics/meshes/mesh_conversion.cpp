// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/meshes/mesh_conversion.h"

#include <filesystem>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "physics/engine/file_registry.h"
#include "physics/meshes/mesh_file.h"
#include "physics/meshes/triangle_mesh.h"
#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {

namespace {

constexpr double kSheet = 1e-4;  ///< thickness of a flat visual mesh [m]
/// Thickness of a flat collision mesh [m]: nothing may pass through it within a step.
constexpr double kPlate = 0.01;
constexpr int kMaxHullVertices = 2000;  ///< vertices: MuJoCo needs 0.2 s for their hull
/// MuJoCo ignores bodies below 1e-15 m^3; a body fills a part of its box.
constexpr double kMinBoxVolume = 1e-13;  ///< [m^3]

/// Changes with the requested part and with the file.
std::string keyOf(const MeshSource& source) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(source.file, error);
  const auto size = std::filesystem::file_size(source.file, error);
  return source.file + "\n" + source.submesh + "\n" + toText(source.scale) +
         (source.center ? " middle " : " ") + std::to_string(time.time_since_epoch().count()) +
         " " + std::to_string(size);
}

/// Keeps results by key.
template <typename Result, typename Make>
Result cached(const MeshSource& source, const Make& make) {
  static std::mutex mutex;
  static std::map<std::string, Result> known;
  const std::string key = keyOf(source);
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = known.find(key);
  return found != known.end() ? found->second : known.emplace(key, make(source)).first->second;
}

TriangleMesh stretched(TriangleMesh mesh, const Eigen::Vector3d& scale) {
  stretch(scale, &mesh);
  tidy(&mesh);
  return mesh;
}

DrawnMesh makeDrawn(const MeshSource& source) {
  DrawnMesh result;
  const MeshFile read = readMeshFile(source.file, source.submesh, source.center);
  result.is_textured = read.is_textured;
  for (const TriangleMesh& part : read.parts) {
    TriangleMesh mesh = stretched(part, source.scale);
    if (!mesh.faces.empty()) {
      thickenFlat(kSheet, &mesh);
      result.parts.push_back({registerFile(toMsh(mesh), ".msh"), mesh.rgba});
    }
  }
  if (result.parts.empty()) {
    throw std::runtime_error("the mesh " + source.file + " has no size at the scale " +
                             toText(source.scale));
  }
  return result;
}

SolidMesh makeSolid(const MeshSource& source) {
  TriangleMesh mesh;
  for (const TriangleMesh& part : readMeshFile(source.file, source.submesh, source.center).parts) {
    append(part, &mesh);
  }
  mesh = stretched(std::move(mesh), source.scale);
  if (!mesh.faces.empty()) {
    thickenFlat(kPlate, &mesh);
  }
  if (mesh.faces.empty() || extents(mesh).prod() < kMinBoxVolume) {
    throw std::runtime_error("the mesh " + source.file +
                             " is too small or too thin to collide with; are its units and its "
                             "scale (" +
                             toText(source.scale) + ") right?");
  }
  const bool is_convex = isConvex(mesh);
  keepOutermost(kMaxHullVertices, &mesh);
  return {registerFile(toMsh(mesh), ".msh"), is_convex};
}

}  // namespace

DrawnMesh loadMeshToDraw(const MeshSource& source) { return cached<DrawnMesh>(source, makeDrawn); }

SolidMesh loadMeshToCollide(const MeshSource& source) {
  return cached<SolidMesh>(source, makeSolid);
}

}  // namespace franka_sim::physics
