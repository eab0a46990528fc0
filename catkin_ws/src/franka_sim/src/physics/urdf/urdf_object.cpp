// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/urdf/urdf_object.h"

#include <tinyxml2.h>

#include <cstddef>
#include <stdexcept>
#include <utility>

#include "physics/mjcf/robot_model.h"
#include "physics/urdf/urdf_reader.h"

namespace franka_sim::physics {

namespace {

/// An SDF scene of one model from a URDF.
class SceneBuilder {
 public:
  SceneBuilder(const UrdfRobot& urdf, const std::string& name, const ResourceResolver& resolve)
      : urdf_(urdf), resolve_(resolve) {
    scene_.unsupported = urdf.notes;
    scene_.models.push_back({name,
                             Eigen::Isometry3d::Identity(),
                             {},
                             urdf.describes_self_collide && urdf.self_collide});
  }

  SdfScene build() {
    addLink(urdf_.root, Eigen::Isometry3d::Identity());
    return std::move(scene_);
  }

 private:
  const std::string& model() const { return scene_.models.front().name; }

  /// @returns the link's index in the scene. @param pose in the model
  int addLink(int index, const Eigen::Isometry3d& pose) {
    const UrdfLink& link = urdf_.links[index];
    SdfLink result;
    result.name = model() + "::" + link.name;
    result.model = model();
    result.is_static = urdf_.is_static;
    result.gravity = link.gravity;
    result.self_collide = link.self_collide;
    result.pose = pose;
    result.inertial = link.inertial.value_or(UrdfInertial{});
    if (result.inertial.mass == 0 && !link.collisions.empty() && !urdf_.is_static) {
      scene_.unsupported.insert("link '" + result.name +
                                "' (it has no mass: that of its shapes at 1000 kg/m^3 is used)");
    }
    for (const UrdfGeometry& geometry : link.collisions) {
      result.collisions.push_back(shapeOf(geometry, link.name, result.collisions.size()));
      result.collisions.back().surface.mu = link.friction.value_or(SdfSurface{}.mu);
    }
    for (const UrdfGeometry& geometry : link.visuals) {
      result.visuals.push_back(shapeOf(geometry, link.name, result.visuals.size()));
      result.visuals.back().rgba = geometry.rgba;
    }
    const int own = static_cast<int>(scene_.links.size());
    scene_.links.push_back(std::move(result));
    scene_.models.front().links.push_back(own);
    for (const CameraSensor& camera : link.cameras) {
      scene_.cameras.emplace_back(camera, own);
    }
    for (const int child : link.child_joints) {
      addJoint(urdf_.joints[child], own, pose);
    }
    return own;
  }

  void addJoint(const UrdfJoint& joint, int parent, const Eigen::Isometry3d& parent_pose) {
    const Eigen::Isometry3d pose = parent_pose * joint.origin;
    SdfJoint result;
    result.name = model() + "::" + joint.name;
    result.parent = parent;
    result.position = pose.translation();
    result.axis = pose.linear() * joint.axis;
    result.damping = joint.damping;
    result.friction = joint.friction;
    switch (joint.type) {
      case UrdfJoint::Type::kFixed:
        result.kind = SdfJoint::Kind::kFixed;
        break;
      case UrdfJoint::Type::kContinuous:
        result.kind = SdfJoint::Kind::kHinge;
        break;
      case UrdfJoint::Type::kRevolute:
      case UrdfJoint::Type::kPrismatic:
        result.kind = joint.type == UrdfJoint::Type::kRevolute ? SdfJoint::Kind::kHinge
                                                               : SdfJoint::Kind::kSlide;
        result.limits = {joint.lower, joint.upper};
        break;
    }
    if (!joint.mimic.empty()) {
      scene_.unsupported.insert("<mimic> of joint '" + result.name + "'");
    }
    result.child = addLink(joint.child, pose);
    scene_.joints.push_back(result);
  }

  SdfShape shapeOf(const UrdfGeometry& geometry, const std::string& link, std::size_t number) {
    SdfShape shape;
    shape.name = link + "_" + std::to_string(number);
    shape.pose = geometry.origin;
    shape.size = geometry.size;
    switch (geometry.shape) {
      case UrdfGeometry::Shape::kBox:
        shape.kind = SdfShape::Kind::kBox;
        break;
      case UrdfGeometry::Shape::kCylinder:
        shape.kind = SdfShape::Kind::kCylinder;
        break;
      case UrdfGeometry::Shape::kSphere:
        shape.kind = SdfShape::Kind::kSphere;
        break;
      case UrdfGeometry::Shape::kMesh:
        shape.kind = SdfShape::Kind::kMesh;
        shape.mesh.file = fileOf(geometry.mesh);
        shape.mesh.scale = geometry.scale;
        break;
    }
    return shape;
  }

  /// The name itself if it is not found, for the note about it.
  std::string fileOf(const std::string& uri) const {
    const std::string found = resolve_ ? resolve_(uri) : std::string();
    return found.empty() ? uri : found;
  }

  const UrdfRobot& urdf_;
  const ResourceResolver& resolve_;
  SdfScene scene_;
};

bool hasArm(const UrdfRobot& urdf) {
  RobotModel robot;
  robot.urdf = urdf;
  for (const UrdfJoint& joint : urdf.joints) {
    if (joint.type != UrdfJoint::Type::kPrismatic && robot.isFranka(joint)) {
      return true;
    }
  }
  return false;
}

}  // namespace

SdfScene readUrdfObject(const std::string& text, const std::string& name,
                        const ResourceResolver& resolve) {
  const UrdfRobot urdf = readUrdf(text, name);
  return SceneBuilder(urdf, name, resolve).build();
}

}  // namespace franka_sim::physics

namespace franka_sim {

bool isUrdfOfObject(const std::string& urdf) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.c_str(), urdf.size()) != tinyxml2::XML_SUCCESS) {
    return false;
  }
  const auto* root = document.FirstChildElement("robot");
  if (root == nullptr || root->FirstChildElement("transmission") != nullptr) {
    return false;
  }
  try {
    const physics::UrdfRobot robot = physics::readUrdf(urdf, "object");
    return robot.link("world") < 0 && !robot.has_control_plugin && !physics::hasArm(robot);
  } catch (const std::runtime_error&) {
    return false;  // the reader of robots reports the error
  }
}

}  // namespace franka_sim
