// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/urdf/urdf_reader.h"

#include <map>
#include <optional>
#include <utility>

#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/xml_util.h"
#include "physics/urdf/gazebo_elements.h"
#include "physics/urdf/held_joints.h"
#include "physics/urdf/urdf_elements.h"

namespace franka_sim::physics {

namespace {

using tinyxml2::XMLElement;
using Materials = std::map<std::string, std::array<double, 4>>;

double positive(const XMLElement& element, const char* attribute, const std::string& where) {
  const double value = number(element, attribute, where);
  if (value <= 0) {
    failAt(where, std::string("'") + attribute + "' of <" + element.Name() +
                      "> must be greater than zero.");
  }
  return value;
}

UrdfGeometry readGeometry(const XMLElement& parent, const std::string& where) {
  const XMLElement* geometry = parent.FirstChildElement("geometry");
  const XMLElement* shape = geometry != nullptr ? geometry->FirstChildElement() : nullptr;
  if (shape == nullptr) {
    failAt(where, std::string("<") + parent.Name() + "> in line " +
                      std::to_string(parent.GetLineNum()) + " has no geometry.");
  }
  UrdfGeometry result;
  result.origin = readOrigin(parent, where);
  const std::string kind = shape->Name();
  if (kind == "box") {
    result.shape = UrdfGeometry::Shape::kBox;
    required(*shape, "size", where);
    result.size = readVector(*shape, "size", {0, 0, 0}, where);
    if (result.size.minCoeff() <= 0) {
      failAt(where, "the edges of a <box> must be greater than zero.");
    }
  } else if (kind == "cylinder") {
    result.shape = UrdfGeometry::Shape::kCylinder;
    result.size = {positive(*shape, "radius", where), positive(*shape, "length", where), 0};
  } else if (kind == "sphere") {
    result.shape = UrdfGeometry::Shape::kSphere;
    result.size = {positive(*shape, "radius", where), 0, 0};
  } else if (kind == "mesh") {
    result.shape = UrdfGeometry::Shape::kMesh;
    result.mesh = required(*shape, "filename", where);
    result.scale = readVector(*shape, "scale", {1, 1, 1}, where);
  } else {
    failAt(where, "<" + kind + "> is not a geometry; known are box, cylinder, sphere and mesh.");
  }
  return result;
}

std::optional<std::array<double, 4>> readMaterial(const XMLElement& parent,
                                                  const Materials& materials,
                                                  const std::string& where) {
  const XMLElement* material = parent.FirstChildElement("material");
  if (material == nullptr) {
    return std::nullopt;
  }
  if (const XMLElement* color = material->FirstChildElement("color")) {
    const auto rgba = numbers(*color, "rgba", {0.8, 0.8, 0.8, 1}, where);
    return std::array<double, 4>{rgba[0], rgba[1], rgba[2], rgba[3]};
  }
  const auto known = materials.find(optional(*material, "name"));
  return known == materials.end() ? std::nullopt : std::make_optional(known->second);
}

UrdfInertial readInertial(const XMLElement& element, const std::string& where,
                          std::set<std::string>* notes) {
  UrdfInertial result;
  const Eigen::Isometry3d origin = readOrigin(element, where);
  result.com = origin.translation();
  const XMLElement* mass = element.FirstChildElement("mass");
  const XMLElement* inertia = element.FirstChildElement("inertia");
  if (mass == nullptr || inertia == nullptr) {
    failAt(where, "<inertial> needs <mass> and <inertia>.");
  }
  result.mass = number(*mass, "value", where);
  const double xx = number(*inertia, "ixx", where), yy = number(*inertia, "iyy", where),
               zz = number(*inertia, "izz", where);
  const double xy = numbers(*inertia, "ixy", {0}, where)[0],
               xz = numbers(*inertia, "ixz", {0}, where)[0],
               yz = numbers(*inertia, "iyz", {0}, where)[0];
  result.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  if (result.mass < 0) {
    failAt(where, "the mass is negative.");
  }
  result.inertia = possibleInertia(result.inertia, where, notes);
  result.inertia = origin.linear() * result.inertia * origin.linear().transpose();
  return result;
}

UrdfLink readLink(const XMLElement& element, const Materials& materials, const std::string& robot,
                  std::set<std::string>* notes) {
  UrdfLink link;
  link.name = required(element, "name", robot);
  const std::string where = robot + ", link '" + link.name + "'";
  if (const XMLElement* inertial = element.FirstChildElement("inertial")) {
    link.inertial = readInertial(*inertial, where, notes);
  }
  for (auto* e = element.FirstChildElement("collision"); e != nullptr;
       e = e->NextSiblingElement("collision")) {
    link.collisions.push_back(readGeometry(*e, where));
  }
  for (auto* e = element.FirstChildElement("visual"); e != nullptr;
       e = e->NextSiblingElement("visual")) {
    link.visuals.push_back(readGeometry(*e, where));
    link.visuals.back().rgba = readMaterial(*e, materials, where);
  }
  return link;
}

UrdfJoint::Type readType(const XMLElement& element, const std::string& where) {
  static const std::map<std::string, UrdfJoint::Type> kTypes{
      {"fixed", UrdfJoint::Type::kFixed},
      {"revolute", UrdfJoint::Type::kRevolute},
      {"continuous", UrdfJoint::Type::kContinuous},
      {"prismatic", UrdfJoint::Type::kPrismatic}};
  const std::string type = required(element, "type", where);
  const auto known = kTypes.find(type);
  if (known == kTypes.end()) {
    failAt(where, "joints of type '" + type +
                      "' cannot be simulated; use fixed, revolute, continuous or prismatic.");
  }
  return known->second;
}

void readLimits(const XMLElement& element, const std::string& where, UrdfJoint* joint) {
  if (joint->type != UrdfJoint::Type::kRevolute && joint->type != UrdfJoint::Type::kPrismatic) {
    return;
  }
  const XMLElement* limit = element.FirstChildElement("limit");  // holdJoints() fixed those without
  joint->lower = numbers(*limit, "lower", {0}, where)[0];
  joint->upper = numbers(*limit, "upper", {0}, where)[0];
  if (joint->lower > joint->upper) {
    failAt(where, "the lower limit " + toText({joint->lower}) + " is not below the upper limit " +
                      toText({joint->upper}) + ".");
  }
}

void readDynamics(const XMLElement& element, const std::string& where, UrdfJoint* joint) {
  const XMLElement* dynamics = element.FirstChildElement("dynamics");
  if (dynamics == nullptr) {
    return;
  }
  joint->damping = numbers(*dynamics, "damping", {0}, where)[0];
  joint->friction = numbers(*dynamics, "friction", {0}, where)[0];
  if (joint->damping < 0 || joint->friction < 0) {
    failAt(where, "damping and friction must not be negative.");
  }
}

int linkOf(const XMLElement& element, const char* role, const UrdfRobot& robot,
           const std::string& where) {
  const XMLElement* end = element.FirstChildElement(role);
  if (end == nullptr) {
    failAt(where, std::string("<") + role + "> is missing.");
  }
  const std::string name = required(*end, "link", where);
  const int index = robot.link(name);
  if (index < 0) {
    failAt(where, std::string("its ") + role + " link '" + name + "' does not exist.");
  }
  return index;
}

UrdfJoint readJoint(const XMLElement& element, const UrdfRobot& robot, const std::string& context) {
  UrdfJoint joint;
  joint.name = required(element, "name", context);
  const std::string where = context + ", joint '" + joint.name + "'";
  joint.type = readType(element, where);
  joint.parent = linkOf(element, "parent", robot, where);
  joint.child = linkOf(element, "child", robot, where);
  joint.origin = readOrigin(element, where);
  if (const XMLElement* axis = element.FirstChildElement("axis")) {
    joint.axis = readVector(*axis, "xyz", {1, 0, 0}, where);
    if (joint.axis.norm() < 1e-9) {
      failAt(where, "its axis has no direction.");
    }
    joint.axis.normalize();
  }
  readLimits(element, where, &joint);
  readDynamics(element, where, &joint);
  if (const XMLElement* mimic = element.FirstChildElement("mimic")) {
    joint.mimic = required(*mimic, "joint", where);
    joint.mimic_multiplier = numbers(*mimic, "multiplier", {1}, where)[0];
    joint.mimic_offset = numbers(*mimic, "offset", {0}, where)[0];
  }
  return joint;
}

void connect(UrdfRobot* robot, const std::string& where) {
  for (std::size_t j = 0; j < robot->joints.size(); ++j) {
    const UrdfJoint& joint = robot->joints[j];
    UrdfLink& child = robot->links[joint.child];
    if (child.parent_joint >= 0) {
      failAt(where, "link '" + child.name + "' has two parent joints, '" +
                        robot->joints[child.parent_joint].name + "' and '" + joint.name + "'.");
    }
    child.parent_joint = static_cast<int>(j);
    robot->links[joint.parent].child_joints.push_back(static_cast<int>(j));
    const int leader = joint.mimic.empty() ? 0 : robot->joint(joint.mimic);
    if (leader < 0 || (!joint.mimic.empty() && joint.mimic == joint.name)) {
      failAt(where, "joint '" + joint.name + "' mimics '" + joint.mimic +
                        "', which is not another joint of this robot.");
    }
  }
}

int countBelow(const UrdfRobot& robot, int link) {
  int count = 1;
  for (const int joint : robot.links[link].child_joints) {
    count += countBelow(robot, robot.joints[joint].child);
  }
  return count;
}

void findRoot(UrdfRobot* robot, const std::string& where) {
  for (std::size_t i = 0; i < robot->links.size(); ++i) {
    if (robot->links[i].parent_joint >= 0) {
      continue;
    }
    if (robot->root >= 0) {
      failAt(where, "two links have no parent, '" + robot->links[robot->root].name + "' and '" +
                        robot->links[i].name + "'; a robot is one tree.");
    }
    robot->root = static_cast<int>(i);
  }
  if (robot->root < 0 || countBelow(*robot, robot->root) != static_cast<int>(robot->links.size())) {
    failAt(where, "its joints form a loop; a robot is a tree.");
  }
}

Materials readMaterials(const XMLElement& root, const std::string& where) {
  Materials materials;
  for (auto* e = root.FirstChildElement("material"); e != nullptr;
       e = e->NextSiblingElement("material")) {
    if (const auto rgba = e->FirstChildElement("color")) {
      const auto v = numbers(*rgba, "rgba", {0.8, 0.8, 0.8, 1}, where);
      materials[optional(*e, "name")] = {v[0], v[1], v[2], v[3]};
    }
  }
  return materials;
}

}  // namespace

UrdfRobot readUrdf(const std::string& text, const std::string& robot_name) {
  const std::string where = "URDF of robot '" + robot_name + "'";
  tinyxml2::XMLDocument document;
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) {
    failAt(where, std::string("not well-formed XML: ") + document.ErrorStr());
  }
  XMLElement* root = document.FirstChildElement("robot");
  if (root == nullptr) {
    failAt(where, "there is no <robot> element.");
  }
  UrdfRobot robot;
  robot.name = robot_name;
  holdJoints(root, where, &robot.notes);
  const Materials materials = readMaterials(*root, where);
  for (auto* e = root->FirstChildElement("link"); e != nullptr; e = e->NextSiblingElement("link")) {
    UrdfLink link = readLink(*e, materials, where, &robot.notes);
    if (robot.link(link.name) >= 0) {
      failAt(where, "two links are called '" + link.name + "'.");
    }
    robot.links.push_back(std::move(link));
  }
  for (auto* e = root->FirstChildElement("joint"); e != nullptr;
       e = e->NextSiblingElement("joint")) {
    UrdfJoint joint = readJoint(*e, robot, where);
    if (robot.joint(joint.name) >= 0) {
      failAt(where, "two joints are called '" + joint.name + "'.");
    }
    robot.joints.push_back(std::move(joint));
  }
  connect(&robot, where);
  findRoot(&robot, where);
  readGazeboElements(*root, where, &robot);
  return robot;
}

}  // namespace franka_sim::physics
