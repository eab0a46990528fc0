// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/urdf/urdf_robot.h"

#include <franka_core/rotations.h>

#include <map>
#include <stdexcept>

#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/xml_util.h"
#include "physics/sdf/sdf_frames.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;
using Materials = std::map<std::string, std::array<double, 4>>;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw std::runtime_error(where + ": " + what);
}

Eigen::Vector3d vector3(const XMLElement& element, const char* attribute,
                        const std::array<double, 3>& fallback, const std::string& where) {
  const auto values = numbers(element, attribute, {fallback[0], fallback[1], fallback[2]}, where);
  return {values[0], values[1], values[2]};
}

Eigen::Isometry3d readOrigin(const XMLElement& parent, const std::string& where) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const XMLElement* origin = parent.FirstChildElement("origin");
  if (origin == nullptr) {
    return pose;
  }
  pose.translation() = vector3(*origin, "xyz", {0, 0, 0}, where);
  const Eigen::Vector3d rpy = vector3(*origin, "rpy", {0, 0, 0}, where);
  if (rpy != Eigen::Vector3d::Zero()) {
    pose.linear() = franka_core::rotationFromRpy(rpy);
  }
  return pose;
}

double positive(const XMLElement& element, const char* attribute, const std::string& where) {
  const double value = number(element, attribute, where);
  if (value <= 0) {
    fail(where,
         std::string("'") + attribute + "' of <" + element.Name() + "> must be greater than zero.");
  }
  return value;
}

UrdfGeometry readGeometry(const XMLElement& parent, const std::string& where) {
  const XMLElement* geometry = parent.FirstChildElement("geometry");
  const XMLElement* shape = geometry != nullptr ? geometry->FirstChildElement() : nullptr;
  if (shape == nullptr) {
    fail(where, std::string("<") + parent.Name() + "> in line " +
                    std::to_string(parent.GetLineNum()) + " has no geometry.");
  }
  UrdfGeometry result;
  result.origin = readOrigin(parent, where);
  const std::string kind = shape->Name();
  if (kind == "box") {
    result.shape = UrdfGeometry::Shape::kBox;
    required(*shape, "size", where);
    result.size = vector3(*shape, "size", {0, 0, 0}, where);
    if (result.size.minCoeff() <= 0) {
      fail(where, "the edges of a <box> must be greater than zero.");
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
    result.scale = vector3(*shape, "scale", {1, 1, 1}, where);
  } else {
    fail(where, "<" + kind + "> is not a geometry; known are box, cylinder, sphere and mesh.");
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
    fail(where, "<inertial> needs <mass> and <inertia>.");
  }
  result.mass = number(*mass, "value", where);
  const double xx = number(*inertia, "ixx", where), yy = number(*inertia, "iyy", where),
               zz = number(*inertia, "izz", where);
  const double xy = numbers(*inertia, "ixy", {0}, where)[0],
               xz = numbers(*inertia, "ixz", {0}, where)[0],
               yz = numbers(*inertia, "iyz", {0}, where)[0];
  result.inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  if (result.mass < 0) {
    fail(where, "the mass is negative.");
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
    fail(where, "joints of type '" + type +
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
    fail(where, "the lower limit " + toText({joint->lower}) + " is not below the upper limit " +
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
    fail(where, "damping and friction must not be negative.");
  }
}

int linkOf(const XMLElement& element, const char* role, const UrdfRobot& robot,
           const std::string& where) {
  const XMLElement* end = element.FirstChildElement(role);
  if (end == nullptr) {
    fail(where, std::string("<") + role + "> is missing.");
  }
  const std::string name = required(*end, "link", where);
  const int index = robot.link(name);
  if (index < 0) {
    fail(where, std::string("its ") + role + " link '" + name + "' does not exist.");
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
    joint.axis = vector3(*axis, "xyz", {1, 0, 0}, where);
    if (joint.axis.norm() < 1e-9) {
      fail(where, "its axis has no direction.");
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

/// The first <mu> or <mu1> below an element, at any depth: SDF nests them, old files do not.
const XMLElement* findFriction(const XMLElement& element) {
  for (auto* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string name = child->Name();
    if (name == "mu" || name == "mu1") {
      return child;
    }
    if (const XMLElement* found = findFriction(*child)) {
      return found;
    }
  }
  return nullptr;
}

void readFriction(const XMLElement& gazebo, const std::string& context, UrdfLink* link) {
  const XMLElement* mu = findFriction(gazebo);
  if (mu == nullptr) {
    return;
  }
  const std::string where = context + ", friction of link '" + link->name + "'";
  const auto values = toNumbers(mu->GetText() != nullptr ? mu->GetText() : "", where);
  if (values.size() != 1 || values[0] < 0) {
    fail(where, "<mu> needs one number that is not negative.");
  }
  link->friction = values[0];
}

/// @param link null if the element refers to none
void readSensors(const XMLElement& gazebo, UrdfRobot* robot, UrdfLink* link) {
  const std::string of =
      robot->name + "::" + (link != nullptr ? link->name : optional(gazebo, "reference"));
  for (auto* sensor = gazebo.FirstChildElement("sensor"); sensor != nullptr;
       sensor = sensor->NextSiblingElement("sensor")) {
    const std::string name = of + "::" + optional(*sensor, "name");
    if (link == nullptr) {
      robot->notes.insert("sensor '" + name + "' of type " + optional(*sensor, "type"));
      continue;
    }
    const auto cameras =
        readCameras(*sensor, writtenPose(*sensor, "Sensor '" + name + "'"), name, &robot->notes);
    link->cameras.insert(link->cameras.end(), cameras.begin(), cameras.end());
  }
}

/// That of ros_control is loaded; no other plugin is.
void readPlugins(const XMLElement& gazebo, UrdfRobot* robot) {
  for (auto* plugin = gazebo.FirstChildElement("plugin"); plugin != nullptr;
       plugin = plugin->NextSiblingElement("plugin")) {
    const std::string library = optional(*plugin, "filename");
    const int follower = robot->joint(childText(*plugin, "mimicJoint"));
    if (follower >= 0 && !robot->joints[follower].mimic.empty()) {
      continue;  // this simulation follows <mimic> itself
    }
    if (plugin->FirstChildElement("robotSimType") != nullptr ||
        library.find("gazebo_ros_control") != std::string::npos) {
      robot->has_control_plugin = true;
    } else {
      robot->notes.insert("plugin '" + optional(*plugin, "name") + "' (" + library + ")");
    }
  }
}

/// What a <collision> sets has no effect, apart from its friction. ODE's own settings have no
/// counterpart here, and franka_description has them, too: they are not named.
void noteCollision(const XMLElement& element, const std::string& what,
                   std::set<std::string>* notes) {
  static const std::set<std::string> known{"mu", "max_contacts", "max_vel", "min_depth"};
  for (auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string name = e->Name();
    const bool is_same = name == "mu2" && childText(element, "mu2") == childText(element, "mu");
    if (e->FirstChildElement() != nullptr) {
      noteCollision(*e, what, notes);
    } else if (e->GetText() != nullptr && known.count(name) == 0 && !is_same) {
      notes->insert("<" + name + "> of a collision of " + what);
    }
  }
}

bool hasGravity(const XMLElement& gazebo) {
  return isTrue(gazebo, "gravity", true) && !isTrue(gazebo, "turnGravityOff", false);
}

/// <self_collide> or <selfCollide>; nothing without them.
std::optional<bool> selfCollideOf(const XMLElement& gazebo, const std::string& context) {
  for (const char* name : {"self_collide", "selfCollide"}) {
    if (const XMLElement* element = gazebo.FirstChildElement(name)) {
      bool collides = false;
      if (element->QueryBoolText(&collides) != tinyxml2::XML_SUCCESS) {
        fail(context, "<" + std::string(name) + "> must say true or false.");
      }
      return collides;
    }
  }
  return std::nullopt;
}

/// Settings of Gazebo that have no effect here, with what they are of.
void noteUnread(const XMLElement& gazebo, UrdfRobot* robot) {
  const std::string reference = optional(gazebo, "reference");
  const std::string what = reference.empty() ? "the model" : "'" + reference + "'";
  if (!reference.empty() && robot->link(reference) < 0 && robot->joint(reference) < 0) {
    robot->notes.insert("<gazebo> of " + what + ", which is neither a link nor a joint");
    return;
  }
  if (!hasGravity(gazebo) && robot->link(reference) < 0) {
    robot->notes.insert("gravity that is off, of " + what);
  }
  for (auto* collision = gazebo.FirstChildElement("collision"); collision != nullptr;
       collision = collision->NextSiblingElement("collision")) {
    noteCollision(*collision, what, &robot->notes);
  }
  // Fixed joints are always kept; forces of joints can always be read.
  noteUnknown(gazebo, what,
              {"sensor", "plugin", "static", "self_collide", "selfCollide", "collision", "mu",
               "mu1", "gravity", "turnGravityOff", "provideFeedback", "preserveFixedJoint",
               "disableFixedJointLumping"},
              &robot->notes);
  if (!reference.empty() && gazebo.FirstChildElement("static") != nullptr) {
    robot->notes.insert("<static> of " + what);
  }
  if (robot->link(reference) < 0 && robot->joint(reference) >= 0 && selfCollideOf(gazebo, "")) {
    robot->notes.insert("<self_collide> of " + what);
  }
}

/// The <gazebo> elements.
void readExtensions(const XMLElement& root, const std::string& context, UrdfRobot* robot) {
  for (auto* e = root.FirstChildElement("gazebo"); e != nullptr;
       e = e->NextSiblingElement("gazebo")) {
    const std::optional<bool> self_collide = selfCollideOf(*e, context);
    if (e->Attribute("reference") == nullptr) {
      if (self_collide) {
        robot->self_collide = *self_collide;
        robot->describes_self_collide = true;
      }
      robot->is_static = isTrue(*e, "static", robot->is_static);
    }
    const int index = robot->link(optional(*e, "reference"));
    UrdfLink* const link = index < 0 ? nullptr : &robot->links[index];
    if (link != nullptr) {
      readFriction(*e, context, link);
      link->gravity = link->gravity && hasGravity(*e);
      link->self_collide = self_collide ? self_collide : link->self_collide;
    }
    readSensors(*e, robot, link);
    readPlugins(*e, robot);
    noteUnread(*e, robot);
  }
  if (!robot->describes_self_collide) {
    robot->self_collide = !robot->has_control_plugin;
  }
}

void connect(UrdfRobot* robot, const std::string& where) {
  for (std::size_t j = 0; j < robot->joints.size(); ++j) {
    const UrdfJoint& joint = robot->joints[j];
    UrdfLink& child = robot->links[joint.child];
    if (child.parent_joint >= 0) {
      fail(where, "link '" + child.name + "' has two parent joints, '" +
                      robot->joints[child.parent_joint].name + "' and '" + joint.name + "'.");
    }
    child.parent_joint = static_cast<int>(j);
    robot->links[joint.parent].child_joints.push_back(static_cast<int>(j));
    const int leader = joint.mimic.empty() ? 0 : robot->joint(joint.mimic);
    if (leader < 0 || (!joint.mimic.empty() && joint.mimic == joint.name)) {
      fail(where, "joint '" + joint.name + "' mimics '" + joint.mimic +
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
      fail(where, "two links have no parent, '" + robot->links[robot->root].name + "' and '" +
                      robot->links[i].name + "'; a robot is one tree.");
    }
    robot->root = static_cast<int>(i);
  }
  if (robot->root < 0 || countBelow(*robot, robot->root) != static_cast<int>(robot->links.size())) {
    fail(where, "its joints form a loop; a robot is a tree.");
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

/// The position [rad] or [m] of a joint that cannot move. @param held those found before
std::optional<double> onlyPosition(const XMLElement& joint,
                                   const std::map<std::string, double>& held,
                                   const std::string& where) {
  const std::string type = optional(joint, "type");
  if (type == "revolute" || type == "prismatic") {
    const XMLElement* limit = joint.FirstChildElement("limit");
    const double lower = limit == nullptr ? 0 : numbers(*limit, "lower", {0}, where)[0];
    if (limit == nullptr || lower == numbers(*limit, "upper", {0}, where)[0]) {
      return lower;
    }
  }
  const XMLElement* mimic = type == "fixed" ? nullptr : joint.FirstChildElement("mimic");
  const auto leader = mimic == nullptr ? held.end() : held.find(optional(*mimic, "joint"));
  if (leader == held.end()) {
    return std::nullopt;
  }
  return numbers(*mimic, "offset", {0}, where)[0] +
         numbers(*mimic, "multiplier", {1}, where)[0] * leader->second;
}

/// Makes a joint fixed at a position [rad] or [m] along its axis.
void hold(XMLElement* joint, double position, const std::string& where) {
  const bool slides = optional(*joint, "type") == "prismatic";
  joint->SetAttribute("type", "fixed");
  if (XMLElement* mimic = joint->FirstChildElement("mimic")) {
    joint->DeleteChild(mimic);
  }
  if (position == 0.0) {
    return;
  }
  const XMLElement* axis = joint->FirstChildElement("axis");
  const Eigen::Vector3d along =
      axis == nullptr ? Eigen::Vector3d(1, 0, 0) : vector3(*axis, "xyz", {1, 0, 0}, where);
  Eigen::Isometry3d pose = readOrigin(*joint, where);
  if (slides) {
    pose.translate(Eigen::Vector3d(position * along.normalized()));
  } else {
    pose.rotate(Eigen::AngleAxisd(position, along.normalized()));
  }
  XMLElement* origin = joint->FirstChildElement("origin");
  origin = origin != nullptr ? origin : append(joint, "origin");
  const Eigen::Vector3d ypr = pose.linear().eulerAngles(2, 1, 0);
  origin->SetAttribute("xyz", toText(Eigen::Vector3d(pose.translation())).c_str());
  origin->SetAttribute("rpy", toText(Eigen::Vector3d(ypr.reverse())).c_str());
}

}  // namespace

bool holdJoints(XMLElement* root, const std::string& where, std::set<std::string>* notes) {
  std::map<std::string, double> held;
  for (std::size_t before = 1; before != held.size();) {
    before = held.size();  // another round finds the followers of what was held in this one
    for (auto* joint = root->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      const std::string name = optional(*joint, "name");
      const std::string context = where + ", joint '" + name + "'";
      if (const auto position = onlyPosition(*joint, held, context)) {
        hold(joint, *position, context);
        held[name] = *position;
        notes->insert("joint '" + name + "' (it has no range and is held at " +
                      toText({*position}) + ")");
      }
    }
  }
  return !held.empty();
}

int UrdfRobot::link(const std::string& link_name) const noexcept {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == link_name) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

int UrdfRobot::joint(const std::string& joint_name) const noexcept {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == joint_name) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

UrdfRobot readUrdf(const std::string& text, const std::string& robot_name) {
  const std::string where = "URDF of robot '" + robot_name + "'";
  tinyxml2::XMLDocument document;
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) {
    fail(where, std::string("not well-formed XML: ") + document.ErrorStr());
  }
  XMLElement* root = document.FirstChildElement("robot");
  if (root == nullptr) {
    fail(where, "there is no <robot> element.");
  }
  UrdfRobot robot;
  robot.name = robot_name;
  holdJoints(root, where, &robot.notes);
  const Materials materials = readMaterials(*root, where);
  for (auto* e = root->FirstChildElement("link"); e != nullptr; e = e->NextSiblingElement("link")) {
    UrdfLink link = readLink(*e, materials, where, &robot.notes);
    if (robot.link(link.name) >= 0) {
      fail(where, "two links are called '" + link.name + "'.");
    }
    robot.links.push_back(std::move(link));
  }
  for (auto* e = root->FirstChildElement("joint"); e != nullptr;
       e = e->NextSiblingElement("joint")) {
    UrdfJoint joint = readJoint(*e, robot, where);
    if (robot.joint(joint.name) >= 0) {
      fail(where, "two joints are called '" + joint.name + "'.");
    }
    robot.joints.push_back(std::move(joint));
  }
  connect(&robot, where);
  findRoot(&robot, where);
  readExtensions(*root, where, &robot);
  return robot;
}

}  // namespace franka_sim::physics
