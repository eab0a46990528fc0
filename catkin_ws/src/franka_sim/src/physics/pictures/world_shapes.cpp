// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/pose_conversions.h>
#include <franka_sim/physics/scene.h>
#include <franka_sim/physics/world_shapes.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "physics/engine/model_compiler.h"
#include "physics/engine/model_data.h"
#include "physics/mjcf/mjcf_robot.h"
#include "physics/world/world_impl.h"

namespace franka_sim {

namespace {

constexpr int kFirstHiddenGroup = 3;  // MuJoCo's renderer draws groups 0 to 2 by default

std::optional<Shape::Kind> kindOf(int type) {
  switch (type) {
    case mjGEOM_PLANE:
      return Shape::Kind::kPlane;
    case mjGEOM_SPHERE:
      return Shape::Kind::kSphere;
    case mjGEOM_CAPSULE:
      return Shape::Kind::kCapsule;
    case mjGEOM_ELLIPSOID:
      return Shape::Kind::kEllipsoid;
    case mjGEOM_CYLINDER:
      return Shape::Kind::kCylinder;
    case mjGEOM_BOX:
      return Shape::Kind::kBox;
    case mjGEOM_MESH:
      return Shape::Kind::kMesh;
    default:
      return {};
  }
}

// As MuJoCo's renderer: a material's color, unless the geom has one of its own.
std::array<float, 4> colorOf(const mjModel& model, int geom) {
  constexpr std::array<float, 4> kUnset{0.5F, 0.5F, 0.5F, 1.0F};
  std::array<float, 4> color;
  std::copy_n(model.geom_rgba + 4 * geom, 4, color.begin());
  const int material = model.geom_matid[geom];
  if (material >= 0 && color == kUnset) {
    std::copy_n(model.mat_rgba + 4 * material, 4, color.begin());
  }
  return color;
}

ShapeMesh meshOf(const mjModel& model, int mesh) {
  const float* const vertices = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
  const int* const faces = model.mesh_face + 3 * model.mesh_faceadr[mesh];
  return {{vertices, vertices + 3 * model.mesh_vertnum[mesh]},
          {faces, faces + 3 * model.mesh_facenum[mesh]}};
}

Eigen::Isometry3d poseInBody(const mjModel& model, int geom) {
  const double* const q = model.geom_quat + 4 * geom;
  return Eigen::Translation3d(Eigen::Map<const Eigen::Vector3d>(model.geom_pos + 3 * geom)) *
         Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
}

/// Collects the shapes of a compiled model.
class ShapeReader {
 public:
  ShapeReader(const mjModel& model, const std::vector<NamedFrame>& frames)
      : model_(model), frames_(frames) {}

  WorldShapes read() {
    for (const NamedFrame& frame : frames_) {
      result_.bodies.push_back(frame.name);
    }
    for (int geom = 0; geom < model_.ngeom; geom++) {
      const std::optional<Shape::Kind> kind = kindOf(model_.geom_type[geom]);
      const std::array<float, 4> color = colorOf(model_, geom);
      if (kind && model_.geom_group[geom] < kFirstHiddenGroup && color[3] > 0.0F) {
        add(geom, *kind, color);
      }
    }
    return std::move(result_);
  }

 private:
  void add(int geom, Shape::Kind kind, const std::array<float, 4>& color) {
    Shape shape;
    shape.body = frameOf(geom);
    shape.kind = kind;
    shape.pose = toPose(frames_[shape.body].frame.pose.inverse() * poseInBody(model_, geom));
    shape.color = color;
    if (kind == Shape::Kind::kMesh) {
      shape.mesh = indexOfMesh(model_.geom_dataid[geom]);
    } else {
      std::copy_n(model_.geom_size + 3 * geom, 3, shape.size.begin());
    }
    result_.shapes.push_back(shape);
  }

  // The link that the geom's name begins with, if it is in this body; otherwise the body.
  std::size_t frameOf(int geom) const {
    const int body = model_.geom_bodyid[geom];
    const char* const name = mj_id2name(&model_, mjOBJ_GEOM, geom);
    const std::string link = physics::linkOfGeom(name != nullptr ? name : "");
    const auto found =
        std::find_if(frames_.begin(), frames_.end(), [&](const NamedFrame& candidate) {
          return candidate.name == link && candidate.frame.body == body;
        });
    return found != frames_.end() ? static_cast<std::size_t>(found - frames_.begin())
                                  : static_cast<std::size_t>(body);
  }

  std::size_t indexOfMesh(int mesh) {
    const auto [entry, is_new] = indices_.emplace(mesh, result_.meshes.size());
    if (is_new) {
      result_.meshes.push_back(meshOf(model_, mesh));
    }
    return entry->second;
  }

  const mjModel& model_;
  const std::vector<NamedFrame>& frames_;
  std::map<int, std::size_t> indices_;  // by MuJoCo's number
  WorldShapes result_;
};

}  // namespace

std::function<WorldShapes()> shapesOf(World& world) {
  return [text = captureScene(world).mjcf, frames = implOf(world).ordered_frames] {
    const physics::ModelPtr model = physics::compile(text, "The model to draw");
    return ShapeReader(*model, frames).read();
  };
}

}  // namespace franka_sim
