// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/mjcf_robot.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "physics/contacts/contact_parameters.h"
#include "physics/meshes/mesh_assets.h"
#include "physics/meshes/mesh_conversion.h"
#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/xml_util.h"
#include "physics/stepping/links_without_gravity.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;
constexpr std::array<double, 4> kDefaultColor{0.85, 0.87, 0.9, 1};

/// A URDF expresses a capsule as a cylinder with a ball of its radius on both ends. MuJoCo has
/// capsules, and collides them many times faster than cylinders.
std::vector<std::pair<UrdfGeometry, bool>> findCapsules(const std::vector<UrdfGeometry>& shapes) {
  std::vector<std::pair<UrdfGeometry, bool>> result;
  std::set<std::size_t> used;
  const auto ballAt = [&](const Eigen::Vector3d& center, double radius) {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (shapes[i].shape == UrdfGeometry::Shape::kSphere && used.count(i) == 0 &&
          std::abs(shapes[i].size.x() - radius) < 1e-6 &&
          (shapes[i].origin.translation() - center).norm() < 1e-6) {
        return static_cast<int>(i);
      }
    }
    return -1;
  };
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].shape != UrdfGeometry::Shape::kCylinder) {
      continue;
    }
    const Eigen::Vector3d half(0, 0, shapes[i].size.y() / 2);
    const int top = ballAt(shapes[i].origin * half, shapes[i].size.x());
    const int bottom = ballAt(shapes[i].origin * -half, shapes[i].size.x());
    if (top >= 0 && bottom >= 0 && top != bottom) {
      used.insert({i, static_cast<std::size_t>(top), static_cast<std::size_t>(bottom)});
      result.emplace_back(shapes[i], true);
    }
  }
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (used.count(i) == 0) {
      result.emplace_back(shapes[i], false);
    }
  }
  return result;
}

class Writer {
 public:
  Writer(const RobotModel& robot, const MjcfTarget& target) : robot_(robot), target_(target) {}

  void write() {
    const UrdfLink& root = robot_.urdf.links[robot_.urdf.root];
    if (root.name == "world") {  // not a segment
      writeCameras(root, Eigen::Isometry3d::Identity(), target_.worldbody);
    }
    std::vector<XMLElement*> bodies;
    for (const Segment& segment : robot_.segments) {
      XMLElement* parent = segment.parent < 0 ? target_.worldbody : bodies[segment.parent];
      XMLElement* body = append(parent, "body");
      body->SetAttribute("name", nameOf(segment).c_str());
      setPose(body, segment.pose);
      bodies.push_back(body);
      writeInertial(segment.inertial, body);
      writeJoint(segment, body);
      for (const auto& [link, pose] : segment.links) {
        writeShapes(robot_.urdf.links[link], pose, body);
        writeCameras(robot_.urdf.links[link], pose, body);
        writeGravity(robot_.urdf.links[link], pose, body);
      }
    }
    writeEqualities();
    if (!target_.visuals) {
      writeExcludes();
      writeGraspPairs();
    }
  }

 private:
  const std::string& nameOf(const Segment& segment) const {
    return robot_.urdf.links[segment.link].name;
  }

  static void writeCameras(const UrdfLink& link, const Eigen::Isometry3d& pose, XMLElement* body) {
    for (const CameraSensor& camera : link.cameras) {
      writeCamera(camera, pose, body);
    }
  }

  static void writeGravity(const UrdfLink& link, const Eigen::Isometry3d& pose, XMLElement* body) {
    if (!link.gravity && link.inertial) {
      LinksWithoutGravity::write(link.name, link.inertial->mass, pose * link.inertial->com, body);
    }
  }

  void writeJoint(const Segment& segment, XMLElement* body) {
    if (segment.joint < 0) {
      return;
    }
    const UrdfJoint& joint = robot_.urdf.joints[segment.joint];
    const bool slides = joint.type == UrdfJoint::Type::kPrismatic;
    XMLElement* e = append(body, "joint");
    e->SetAttribute("name", joint.name.c_str());
    e->SetAttribute("type", slides ? "slide" : "hinge");
    e->SetAttribute("pos", "0 0 0");
    e->SetAttribute("axis", toText(joint.axis).c_str());
    const bool limited = joint.type != UrdfJoint::Type::kContinuous;
    e->SetAttribute("limited", limited ? "true" : "false");
    if (limited) {
      const auto stops = robot_.stops(joint);
      const double unit = slides ? 1.0 : target_.angle_unit;
      e->SetAttribute("range", toText({stops[0] / unit, stops[1] / unit}).c_str());
      e->SetAttribute("margin", "0");
      e->SetAttribute("solreflimit", kStopSolref);
      e->SetAttribute("solimplimit", kContactSolimp);
    }
    e->SetAttribute("stiffness", "0");
    e->SetAttribute("armature", toText({robot_.armature(joint)}).c_str());
    e->SetAttribute("damping", toText({robot_.damping(joint)}).c_str());
    e->SetAttribute("frictionloss", toText({robot_.friction(joint)}).c_str());
  }

  void writeShapes(const UrdfLink& link, const Eigen::Isometry3d& pose, XMLElement* body) {
    if (!target_.visuals) {
      writeCollisions(link, pose, body);
    } else if (!writeVisuals(link, pose, body)) {
      writeCollisionsToLookAt(link, pose, body);
    }
  }

  void writeCollisions(const UrdfLink& link, const Eigen::Isometry3d& pose, XMLElement* body) {
    int count = 0;
    for (const auto& [shape, is_capsule] : findCapsules(link.collisions)) {
      XMLElement* geom = writeGeom(shape, is_capsule, pose, body);
      if (shape.shape == UrdfGeometry::Shape::kMesh) {
        const std::string where =
            "Robot '" + robot_.description.name + "', link '" + link.name + "'";
        setMesh(geom, collisionFile(shape.mesh, robot_.description.resolve, where), shape.scale);
      }
      const std::string name = link.name + "/collision_" + std::to_string(count++);
      geom->SetAttribute("name", name.c_str());
      geom->SetAttribute("contype", "1");
      geom->SetAttribute("conaffinity", "1");
      geom->SetAttribute("condim", kCondim);
      geom->SetAttribute("friction",
                         toText({frictionOf(link), kTorsionalFriction, kRollingFriction}).c_str());
      geom->SetAttribute("solref", kContactSolref);
      geom->SetAttribute("solimp", kContactSolimp);
      geom->SetAttribute("margin", "0");
      geom->SetAttribute("gap", "0");
      geom->SetAttribute("group", "3");
      geoms_of_[link.name].push_back(name);
    }
  }

  bool writeVisuals(const UrdfLink& link, const Eigen::Isometry3d& pose, XMLElement* body) {
    bool all = !link.visuals.empty();
    for (const UrdfGeometry& shape : link.visuals) {
      all = all && (shape.shape != UrdfGeometry::Shape::kMesh ||
                    !visualParts(shape.mesh, robot_.description.resolve).empty());
    }
    if (!all) {
      return false;
    }
    int count = 0;
    for (const auto& [shape, is_capsule] : findCapsules(link.visuals)) {
      if (shape.shape != UrdfGeometry::Shape::kMesh) {
        setLook(writeGeom(shape, is_capsule, pose, body), shape.rgba.value_or(kDefaultColor), link,
                count++);
        continue;
      }
      for (const MeshPart& part : visualParts(shape.mesh, robot_.description.resolve)) {
        XMLElement* geom = writeGeom(shape, false, pose, body);
        setMesh(geom, part.file, shape.scale);
        setLook(geom, part.rgba.value_or(shape.rgba.value_or(kDefaultColor)), link, count++);
      }
    }
    return true;
  }

  /// For links whose visual cannot be read: collision shapes instead of a gap in the robot.
  void writeCollisionsToLookAt(const UrdfLink& link, const Eigen::Isometry3d& pose,
                               XMLElement* body) {
    int count = 0;
    for (const auto& [shape, is_capsule] : findCapsules(link.collisions)) {
      std::vector<MeshPart> parts;
      if (shape.shape == UrdfGeometry::Shape::kMesh) {
        parts = visualParts(shape.mesh, robot_.description.resolve);
        if (parts.empty()) {
          continue;
        }
      }
      XMLElement* geom = writeGeom(shape, is_capsule, pose, body);
      if (!parts.empty()) {
        setMesh(geom, parts.front().file, shape.scale);
      }
      setLook(geom, kDefaultColor, link, count++);
    }
  }

  static XMLElement* writeGeom(const UrdfGeometry& shape, bool is_capsule,
                               const Eigen::Isometry3d& pose, XMLElement* body) {
    XMLElement* geom = append(body, "geom");
    setPose(geom, pose * shape.origin);
    switch (shape.shape) {
      case UrdfGeometry::Shape::kBox:
        geom->SetAttribute("type", "box");
        geom->SetAttribute("size", toText(Eigen::Vector3d(shape.size / 2)).c_str());
        break;
      case UrdfGeometry::Shape::kCylinder:
        geom->SetAttribute("type", is_capsule ? "capsule" : "cylinder");
        geom->SetAttribute("size", toText({shape.size.x(), shape.size.y() / 2}).c_str());
        break;
      case UrdfGeometry::Shape::kSphere:
        geom->SetAttribute("type", "sphere");
        geom->SetAttribute("size", toText({shape.size.x()}).c_str());
        break;
      case UrdfGeometry::Shape::kMesh:
        geom->SetAttribute("type", "mesh");
        break;
    }
    return geom;
  }

  void setMesh(XMLElement* geom, const std::string& file, const Eigen::Vector3d& scale) {
    const std::string key = file + " " + toText(scale);
    auto known = meshes_.find(key);
    if (known == meshes_.end()) {
      const std::string name = robot_.description.name + "/mesh_" + std::to_string(meshes_.size());
      XMLElement* mesh = append(target_.assets, "mesh");
      mesh->SetAttribute("name", name.c_str());
      mesh->SetAttribute("file", file.c_str());
      mesh->SetAttribute("scale", toText(scale).c_str());
      known = meshes_.emplace(key, name).first;
    }
    geom->SetAttribute("mesh", known->second.c_str());
  }

  static void setLook(XMLElement* geom, const std::array<double, 4>& rgba, const UrdfLink& link,
                      int number) {
    geom->SetAttribute("name", (link.name + "/visual_" + std::to_string(number)).c_str());
    geom->SetAttribute("contype", "0");
    geom->SetAttribute("conaffinity", "0");
    geom->SetAttribute("group", "2");
    geom->SetAttribute("rgba", toText(rgba.data(), 4).c_str());
  }

  bool isFinger(const UrdfLink& link) const { return robot_.isFinger(link); }

  double frictionOf(const UrdfLink& link) const {
    return link.friction.value_or(isFinger(link) ? kFingerFriction : kLinkFriction);
  }

  void writeEqualities() {
    for (const UrdfJoint& joint : robot_.urdf.joints) {
      if (joint.type == UrdfJoint::Type::kFixed) {
        continue;
      }
      const bool brake = joint.mimic.empty();
      XMLElement* e = append(target_.equality, "joint");
      e->SetAttribute("name", (brake ? brakeName(joint.name) : joint.name + "/mimic").c_str());
      e->SetAttribute("joint1", joint.name.c_str());
      if (brake) {
        e->SetAttribute("active", "false");
        e->SetAttribute("polycoef", "0 0 0 0 0");
      } else {
        e->SetAttribute("joint2", joint.mimic.c_str());
        e->SetAttribute(
            "polycoef",
            toText({joint.mimic_offset, joint.mimic_multiplier, 0.0, 0.0, 0.0}).c_str());
      }
      e->SetAttribute("solref", brake ? kBrakeSolref : kCouplingSolref);
      e->SetAttribute("solimp", kStiffSolimp);
    }
  }

  /// Number of joints between two segments of the tree.
  int distance(int a, int b) const {
    int count = 0;
    while (a != b) {
      // Parents precede children, so the later one is never an ancestor of the other.
      int& later = a > b ? a : b;
      later = robot_.segments[later].parent;
      ++count;
    }
    return count;
  }

  /// Neighbors overlap by construction, and the convex hulls of link5 and link7 do too (their
  /// joint stops, not their shapes, keep them apart). So the fingers of a hand meet at their stop.
  bool mayCollide(int a, int b) const { return selfCollide(a, b) && distance(a, b) > 2; }

  /// As in Gazebo, one of two links decides.
  bool selfCollide(int a, int b) const { return selfCollides(a) || selfCollides(b); }

  bool selfCollides(int segment) const {
    const auto& links = robot_.segments[segment].links;
    return std::any_of(links.begin(), links.end(), [this](const auto& link) {
      return robot_.urdf.links[link.first].self_collide.value_or(robot_.urdf.self_collide);
    });
  }

  void writeExcludes() {
    const int count = static_cast<int>(robot_.segments.size());
    for (int a = 0; a < count; ++a) {
      for (int b = a + 1; b < count; ++b) {
        if (!mayCollide(a, b)) {
          XMLElement* e = append(target_.contact, "exclude");
          e->SetAttribute("body1", nameOf(robot_.segments[a]).c_str());
          e->SetAttribute("body2", nameOf(robot_.segments[b]).c_str());
        }
        if (selfCollide(a, b) && distance(a, b) == 2) {
          writeAttachedPairs(robot_.segments[a], robot_.segments[b]);
          writeAttachedPairs(robot_.segments[b], robot_.segments[a]);
        }
      }
    }
  }

  /// A part fixed to a link protrudes from it: the hand can hit the forearm, though link 7 cannot.
  void writeAttachedPairs(const Segment& with, const Segment& other) {
    for (const auto& [attached, attached_pose] : with.links) {
      if (attached == with.link || isFinger(robot_.urdf.links[other.link])) {
        continue;
      }
      const UrdfLink& link = robot_.urdf.links[attached];
      for (const std::string& geom : geoms_of_[link.name]) {
        for (const auto& [target, target_pose] : other.links) {
          const UrdfLink& hit = robot_.urdf.links[target];
          for (const std::string& target_geom : geoms_of_[hit.name]) {
            writePair({geom, target_geom, std::min(frictionOf(link), frictionOf(hit)),
                       kTorsionalFriction, kCondim, kContactSolref, kContactSolimp});
          }
        }
      }
    }
  }

  struct PairSettings {
    std::string geom1, geom2;
    double sliding, torsion;
    const char *condim, *solref, *solimp;
  };

  void writePair(const PairSettings& pair) {
    XMLElement* e = append(target_.contact, "pair");
    e->SetAttribute("geom1", pair.geom1.c_str());
    e->SetAttribute("geom2", pair.geom2.c_str());
    e->SetAttribute("condim", pair.condim);
    e->SetAttribute("friction", toText({pair.sliding, pair.sliding, pair.torsion, kRollingFriction,
                                        kRollingFriction})
                                    .c_str());
    e->SetAttribute("solref", pair.solref);
    e->SetAttribute("solimp", pair.solimp);
    e->SetAttribute("margin", "0");
    e->SetAttribute("gap", "0");
  }

  void writeGraspPairs() {
    for (const UrdfLink& link : robot_.urdf.links) {
      if (!isFinger(link)) {
        continue;
      }
      for (const std::string& pad : geoms_of_[link.name]) {
        for (const WorldGeom& other : *target_.world) {
          if (other.graspable && other.collides) {
            // MuJoCo would take the larger friction; the more slippery side limits a grasp.
            writePair({pad, other.name, std::min(frictionOf(link), other.friction),
                       std::min(kTorsionalFriction, other.torsion), kGraspCondim, kGraspSolref,
                       kGraspSolimp});
          }
        }
      }
    }
  }

  const RobotModel& robot_;
  const MjcfTarget& target_;
  std::map<std::string, std::string> meshes_;
  std::map<std::string, std::vector<std::string>> geoms_of_;
};

}  // namespace

void writeRobot(const RobotModel& robot, const MjcfTarget& target) {
  Writer(robot, target).write();
}

std::string brakeName(const std::string& joint) { return joint + "/brake"; }

std::string linkOfGeom(const std::string& geom) { return geom.substr(0, geom.rfind('/')); }

}  // namespace franka_sim::physics
