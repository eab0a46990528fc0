// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/meshes/mesh_file.h"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

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

}  // namespace franka_sim::physics
