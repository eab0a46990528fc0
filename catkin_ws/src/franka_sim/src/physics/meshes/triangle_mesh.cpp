// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/meshes/triangle_mesh.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

namespace franka_sim::physics {

namespace {

/// Below this fraction of its length a surface is flat: ten times the resolution of its numbers.
constexpr double kFlat = 1e-6;
constexpr double kConvexTolerance = 0.01;             ///< of the longest extent
constexpr double kGoldenAngle = 2.39996322972865332;  ///< pi (3 - sqrt 5)
/// Faces times vertices that `isConvex` checks: some milliseconds.
constexpr std::size_t kMaxComparisons = 4000000;

/// Principal axes as columns, the one of the shortest extent first.
Eigen::Matrix3d principalAxes(const TriangleMesh& mesh) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    mean += vertex.cast<double>() / static_cast<double>(mesh.vertices.size());
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d d = vertex.cast<double>() - mean;
    spread += d * d.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
}

Eigen::Vector3d extentsAlong(const Eigen::Matrix3d& axes, const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) {
    return Eigen::Vector3d::Zero();
  }
  Eigen::Vector3d least = axes.transpose() * mesh.vertices.front().cast<double>(), most = least;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d along = axes.transpose() * vertex.cast<double>();
    least = least.cwiseMin(along);
    most = most.cwiseMax(along);
  }
  return most - least;
}

/// Vector of twice the area, along the outer normal.
Eigen::Vector3d areaVector(const TriangleMesh& mesh, const std::array<int, 3>& face) {
  const Eigen::Vector3d a = mesh.vertices[face[0]].cast<double>();
  return (mesh.vertices[face[1]].cast<double>() - a)
      .cross(mesh.vertices[face[2]].cast<double>() - a);
}

template <typename Number>
void write(const Number* numbers, std::size_t count, std::string* text) {
  text->append(reinterpret_cast<const char*>(numbers), count * sizeof(Number));
}

}  // namespace

void append(const TriangleMesh& added, TriangleMesh* mesh) {
  const int first = static_cast<int>(mesh->vertices.size());
  mesh->vertices.insert(mesh->vertices.end(), added.vertices.begin(), added.vertices.end());
  for (const auto& [a, b, c] : added.faces) {
    mesh->faces.push_back({first + a, first + b, first + c});
  }
}

void tidy(TriangleMesh* mesh) {
  std::map<std::array<float, 3>, int> places;
  TriangleMesh result;
  result.rgba = mesh->rgba;
  const auto indexOf = [&](int old) {
    const Eigen::Vector3f& v = mesh->vertices[old];
    const auto [place, is_new] =
        places.emplace(std::array{v.x(), v.y(), v.z()}, static_cast<int>(result.vertices.size()));
    if (is_new) {
      result.vertices.push_back(v);
    }
    return place->second;
  };
  for (const auto& [a, b, c] : mesh->faces) {
    const Eigen::Vector3f &u = mesh->vertices[a], &v = mesh->vertices[b], &w = mesh->vertices[c];
    if (u != v && v != w && w != u) {
      result.faces.push_back({indexOf(a), indexOf(b), indexOf(c)});
    }
  }
  *mesh = std::move(result);
}

void stretch(const Eigen::Vector3d& scale, TriangleMesh* mesh) {
  for (Eigen::Vector3f& vertex : mesh->vertices) {
    vertex = vertex.cast<double>().cwiseProduct(scale).cast<float>();
  }
  if (scale.prod() < 0) {
    for (auto& face : mesh->faces) {
      std::swap(face[1], face[2]);
    }
  }
}

void thickenFlat(double thickness, TriangleMesh* mesh) {
  const Eigen::Matrix3d axes = principalAxes(*mesh);
  const Eigen::Vector3d sizes = extentsAlong(axes, *mesh);
  if (sizes[0] > kFlat * sizes[2]) {
    return;
  }
  Eigen::Vector3d front = Eigen::Vector3d::Zero();
  for (const auto& face : mesh->faces) {
    front += areaVector(*mesh, face);
  }
  const double side = front.dot(axes.col(0)) < 0 ? -1 : 1;
  const Eigen::Vector3f back = (-side * thickness * axes.col(0)).cast<float>();
  TriangleMesh other = *mesh;
  for (Eigen::Vector3f& vertex : other.vertices) {
    vertex += back;
  }
  for (auto& face : other.faces) {
    std::swap(face[1], face[2]);
  }
  append(other, mesh);
}

Eigen::Vector3d extents(const TriangleMesh& mesh) {
  return extentsAlong(principalAxes(mesh), mesh);
}

bool isConvex(const TriangleMesh& mesh) {
  const double tolerance = kConvexTolerance * extents(mesh)[2];
  const std::size_t looked_at =
      std::max<std::size_t>(100, kMaxComparisons / std::max<std::size_t>(mesh.vertices.size(), 1));
  const std::size_t step = std::max<std::size_t>(mesh.faces.size() / looked_at, 1);
  for (std::size_t f = 0; f < mesh.faces.size(); f += step) {
    const Eigen::Vector3d area = areaVector(mesh, mesh.faces[f]);
    if (area.norm() == 0) {
      continue;
    }
    // All points of a convex body are on one side of each face, whichever way the face points.
    const Eigen::Vector3d normal = area.normalized();
    const double level = normal.dot(mesh.vertices[mesh.faces[f][0]].cast<double>());
    double least = 0, most = 0;
    for (const Eigen::Vector3f& vertex : mesh.vertices) {
      const double height = normal.dot(vertex.cast<double>()) - level;
      least = std::min(least, height);
      most = std::max(most, height);
    }
    if (least < -tolerance && most > tolerance) {
      return false;
    }
  }
  return true;
}

void keepOutermost(int most, TriangleMesh* mesh) {
  mesh->faces.clear();
  if (mesh->vertices.size() <= static_cast<std::size_t>(most)) {
    return;
  }
  const Eigen::Map<const Eigen::Matrix3Xf> points(mesh->vertices.front().data(), 3,
                                                  static_cast<Eigen::Index>(mesh->vertices.size()));
  std::set<Eigen::Index> kept;
  for (int i = 0; i < most; ++i) {
    // Evenly over a ball: equal steps in height, each turned by the golden angle.
    const double height = 1 - (2 * i + 1.0) / most;
    const double radius = std::sqrt(1 - height * height), angle = i * kGoldenAngle;
    const Eigen::RowVector3f direction(static_cast<float>(radius * std::cos(angle)),
                                       static_cast<float>(radius * std::sin(angle)),
                                       static_cast<float>(height));
    Eigen::Index farthest = 0;
    (direction * points).maxCoeff(&farthest);
    kept.insert(farthest);
  }
  std::vector<Eigen::Vector3f> vertices;
  for (const Eigen::Index index : kept) {
    vertices.emplace_back(points.col(index));
  }
  mesh->vertices = std::move(vertices);
}

std::string toMsh(const TriangleMesh& mesh) {
  const std::int32_t sizes[4] = {static_cast<std::int32_t>(mesh.vertices.size()), 0, 0,
                                 static_cast<std::int32_t>(mesh.faces.size())};
  std::string text;
  write(sizes, 4, &text);
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    write(vertex.data(), 3, &text);
  }
  for (const auto& face : mesh.faces) {
    write(face.data(), 3, &text);
  }
  return text;
}

}  // namespace franka_sim::physics
