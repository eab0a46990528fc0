// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/meshes/mesh_simplification.h"

#include <meshoptimizer.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace franka_sim::physics {

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
