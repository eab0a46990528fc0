// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/meshes/meshes.h"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>

#include "physics/mjcf/model_compiler.h"
#include "physics/mjcf/xml_util.h"

namespace franka_sim::physics {
namespace {

/// Normals and texture coordinates are not used: MuJoCo rounds edges itself.
constexpr unsigned kSteps =
    aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType;

std::optional<std::array<double, 4>> colorOf(const aiMaterial& material) {
  aiColor4D diffuse;
  if (std::string(material.GetName().C_Str()) == AI_DEFAULT_MATERIAL_NAME ||
      material.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse) != aiReturn_SUCCESS) {
    return std::nullopt;
  }
  float opacity = 1;
  material.Get(AI_MATKEY_OPACITY, opacity);
  // Exporters disagree on the meaning of opaque; an author never intends an invisible body.
  const double alpha = opacity > 0 ? opacity : 1;
  return std::array<double, 4>{diffuse.r, diffuse.g, diffuse.b, alpha};
}

bool isTextured(const aiMaterial& material) {
  return material.GetTextureCount(aiTextureType_DIFFUSE) > 0 ||
         material.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
}

/// Collects the meshes in the tree of nodes.
class Collector {
 public:
  Collector(const aiScene& scene, std::string submesh)
      : scene_(scene), submesh_(std::move(submesh)) {}

  void add(const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 pose = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      const aiMesh& mesh = *scene_.mMeshes[node.mMeshes[i]];
      if (submesh_.empty() || submesh_ == node.mName.C_Str() || submesh_ == mesh.mName.C_Str()) {
        add(mesh, pose);
      }
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) {
      add(*node.mChildren[i], pose);
    }
  }

  MeshFile take() { return std::move(result_); }

 private:
  void add(const aiMesh& mesh, const aiMatrix4x4& pose) {
    const aiMaterial& material = *scene_.mMaterials[mesh.mMaterialIndex];
    result_.is_textured = result_.is_textured || isTextured(material);
    TriangleMesh added;
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D v = pose * mesh.mVertices[i];
      added.vertices.emplace_back(v.x, v.y, v.z);
      if (!added.vertices.back().allFinite()) {
        throw std::runtime_error("a coordinate is not a finite number");
      }
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices == 3) {
        added.faces.push_back({static_cast<int>(face.mIndices[0]),
                               static_cast<int>(face.mIndices[1]),
                               static_cast<int>(face.mIndices[2])});
      }
    }
    append(added, &partOf(colorOf(material)));
  }

  TriangleMesh& partOf(const std::optional<std::array<double, 4>>& rgba) {
    for (TriangleMesh& part : result_.parts) {
      if (part.rgba == rgba) {
        return part;
      }
    }
    result_.parts.emplace_back();
    result_.parts.back().rgba = rgba;
    return result_.parts.back();
  }

  const aiScene& scene_;
  std::string submesh_;
  MeshFile result_;
};

MeshFile read(const std::string& file, const std::string& submesh, bool collada_names) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, collada_names);
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFile(file, kSteps);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string reason = importer.GetErrorString();
    throw std::runtime_error(reason.empty() ? "it cannot be read" : reason);
  }
  Collector collector(*scene, submesh);
  collector.add(*scene->mRootNode, aiMatrix4x4());
  MeshFile result = collector.take();
  std::vector<TriangleMesh> parts;
  for (TriangleMesh& part : result.parts) {
    tidy(&part);
    if (!part.faces.empty()) {
      parts.push_back(std::move(part));
    }
  }
  result.parts = std::move(parts);
  return result;
}

void putInTheMiddle(std::vector<TriangleMesh>* parts) {
  Eigen::Vector3f least = parts->front().vertices.front(), most = least;
  for (const TriangleMesh& part : *parts) {
    for (const Eigen::Vector3f& vertex : part.vertices) {
      least = least.cwiseMin(vertex);
      most = most.cwiseMax(vertex);
    }
  }
  for (TriangleMesh& part : *parts) {
    for (Eigen::Vector3f& vertex : part.vertices) {
      vertex -= (least + most) / 2;
    }
  }
}

}  // namespace

MeshFile readMeshFile(const std::string& file, const std::string& submesh, bool center) {
  MeshFile result;
  try {
    result = read(file, submesh, true);
    if (result.parts.empty() && !submesh.empty()) {
      result = read(file, submesh, false);  // Collada nodes without a name are found by their id
    }
  } catch (const std::exception& error) {
    throw std::runtime_error("the mesh " + file + " cannot be read: " + error.what());
  }
  if (result.parts.empty()) {
    throw std::runtime_error("the mesh " + file + " has no triangles" +
                             (submesh.empty() ? "" : " of the name '" + submesh + "'"));
  }
  if (center) {
    putInTheMiddle(&result.parts);
  }
  return result;
}

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

/// Caches results by key.
template <typename Result, typename Make>
Result remembered(const MeshSource& source, const Make& make) {
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

DrawnMesh loadMeshToDraw(const MeshSource& source) {
  return remembered<DrawnMesh>(source, makeDrawn);
}

SolidMesh loadMeshToCollide(const MeshSource& source) {
  return remembered<SolidMesh>(source, makeSolid);
}

}  // namespace franka_sim::physics
