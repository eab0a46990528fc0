// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/mjcf_object.h"

#include <franka_sim/physics/pose_conversions.h>
#include <franka_sim/physics/world.h>

#include <algorithm>
#include <stdexcept>

#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/mjcf_names.h"
#include "physics/mjcf/model_compiler.h"
#include "physics/mjcf/robot_model.h"
#include "physics/mjcf/rotations.h"
#include "physics/mjcf/xml_util.h"
#include "physics/sdf/sdf_scene.h"
#include "physics/urdf/urdf_robot.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;

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

/// An object's URDF as an SDF scene with one model of that name, whose root link is at the origin
/// and free to move, unless <gazebo><static> is true.
/// @param resolve finds its meshes
SdfScene readUrdfObject(const std::string& text, const std::string& name,
                        const ResourceResolver& resolve) {
  const UrdfRobot urdf = readUrdf(text, name);
  return SceneBuilder(urdf, name, resolve).build();
}

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

void checkSections(const XMLElement& root, const std::string& title) {
  for (auto* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string section = e->Name();
    bool known = section == "compiler";
    for (const char* allowed : {"asset", "worldbody", "contact", "equality"}) {
      known = known || section == allowed;
    }
    if (!known) {
      throw std::runtime_error(title + ": its section <" + section +
                               "> would change the whole world; an object may have <asset>, "
                               "<worldbody>, <contact> and <equality>.");
    }
  }
}

/// The unit of the text's angles [rad]; refuses settings that would act on the whole world.
double readAngleUnit(const XMLElement& root, const std::string& title) {
  double unit = kDegree;
  for (auto* e = root.FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler")) {
    for (auto* a = e->FirstAttribute(); a != nullptr; a = a->Next()) {
      const std::string name = a->Name();
      if (name == "angle") {
        unit = optional(*e, "angle") == "radian" ? 1 : kDegree;
      } else if (name != "meshdir" && name != "texturedir" && name != "autolimits") {
        throw std::runtime_error(title + ": the compiler setting '" + name +
                                 "' would change the whole world; remove it.");
      }
    }
  }
  return unit;
}

void scale(XMLElement* element, const char* attribute, std::size_t first, double factor,
           const std::string& title) {
  const char* text = element->Attribute(attribute);
  if (text == nullptr) {
    return;
  }
  std::vector<double> values =
      toNumbers(text, title + ": '" + attribute + "' of <" + element->Name() + ">");
  for (std::size_t i = first; i < values.size(); ++i) {
    values[i] *= factor;
  }
  element->SetAttribute(attribute, toText(values.data(), values.size()).c_str());
}

/// Multiplies all angles below an element.
void scaleAngles(XMLElement* parent, double factor, const std::string& title) {
  for (auto* e = parent->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    scale(e, "euler", 0, factor, title);
    scale(e, "axisangle", 3, factor, title);
    const std::string type = optional(*e, "type");
    if (std::string(e->Name()) == "joint" && type != "slide" && type != "free") {
      for (const char* attribute : {"range", "ref", "springref"}) {
        scale(e, attribute, 0, factor, title);
      }
    }
    scaleAngles(e, factor, title);
  }
}

void nameBodies(XMLElement* parent, const std::string& prefix, const std::string& title,
                int* count) {
  for (auto* e = parent->FirstChildElement("body"); e != nullptr;
       e = e->NextSiblingElement("body")) {
    if (optional(*e, "mocap") == "true") {
      throw std::runtime_error(title +
                               ": bodies moved from outside (mocap) belong into the world "
                               "file.");
    }
    if (e->Attribute("name") == nullptr) {
      const int nth = (*count)++;
      e->SetAttribute("name",
                      (nth == 0 ? prefix : prefix + "/body_" + std::to_string(nth)).c_str());
    }
    nameBodies(e, prefix, title, count);
  }
}

Eigen::Isometry3d isometry(const Pose& pose, const std::string& title) {
  if (!vector(pose.position).allFinite() || !hasUnitOrientation(pose)) {
    throw std::runtime_error(title +
                             ": its pose is not made of finite numbers and a unit "
                             "quaternion.");
  }
  return toIsometry(pose);
}

/// Compiles the object alone, so that errors are its own and every pose notation is resolved.
void place(MjcfObject* object, const Eigen::Isometry3d& pose, const std::string& title) {
  const ModelPtr model = compile(toText(object->document), title);
  XMLElement* worldbody = object->document.RootElement()->FirstChildElement("worldbody");
  bool any = false;
  for (auto* e = worldbody != nullptr ? worldbody->FirstChildElement() : nullptr; e != nullptr;
       e = e->NextSiblingElement()) {
    if (std::string(e->Name()) != "body") {
      throw std::runtime_error(title + ": its <" + e->Name() +
                               "> stands outside of a <body>; put it into one.");
    }
    any = true;
    const int id = mj_name2id(model.get(), mjOBJ_BODY, e->Attribute("name"));
    const double* q = model->body_quat + 4 * id;
    Eigen::Isometry3d own = Eigen::Isometry3d::Identity();
    own.translation() = Eigen::Map<const Eigen::Vector3d>(model->body_pos + 3 * id);
    own.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().matrix();
    for (const char* attribute : {"pos", "quat", "euler", "axisangle", "xyaxes", "zaxis"}) {
      e->DeleteAttribute(attribute);
    }
    setPose(e, pose * own);
  }
  if (!any) {
    throw std::runtime_error(title + ": there is no body in it.");
  }
}

void readMjcf(const std::string& text, double angle_unit, const std::string& title,
              MjcfObject* object) {
  if (object->document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS ||
      object->document.RootElement() == nullptr) {
    throw std::runtime_error(title + ": it is not well-formed XML: " + object->document.ErrorStr());
  }
  XMLElement* root = object->document.RootElement();
  if (std::string(root->Name()) == "body") {
    tinyxml2::XMLDocument lone;
    object->document.DeepCopy(&lone);
    object->document.Clear();
    root = append(&object->document, "mujoco");
    append(root, "worldbody")->InsertEndChild(lone.RootElement()->DeepClone(&object->document));
  } else if (std::string(root->Name()) != "mujoco") {
    throw std::runtime_error(
        title + ": its root element is <" + root->Name() +
        ">; an object is an SDF model (<sdf>), MJCF (<mujoco>), a <body>, or a "
        "URDF (<robot>) without an arm.");
  }
  object->unsupported = dropKeyframes(root);
  object->unsupported.merge(noteAutolimits(*root));
  checkSections(*root, title);
  repairInertias(root, title, &object->unsupported);
  const double own_unit = readAngleUnit(*root, title);
  if (own_unit != angle_unit) {
    scaleAngles(root, own_unit / angle_unit, title);
  }
  makeFilesAbsolute(root, "");
  while (XMLElement* own = root->FirstChildElement("compiler")) {
    root->DeleteChild(own);
  }
  XMLElement* compiler = append(root, "compiler");
  compiler->SetAttribute("angle", angle_unit == 1 ? "radian" : "degree");
  compiler->SetAttribute("autolimits", "true");
  int bodies = 0, geoms = 0;
  for (auto* e = root->FirstChildElement("worldbody"); e != nullptr;
       e = e->NextSiblingElement("worldbody")) {
    nameBodies(e, object->name, title, &bodies);
    nameGeoms(e, object->name, &geoms);
  }
  XMLElement* worldbody = root->FirstChildElement("worldbody");
  XMLElement* first = worldbody != nullptr ? worldbody->FirstChildElement("body") : nullptr;
  if (first != nullptr && object->name != first->Attribute("name")) {
    object->aliases.push_back({object->name, first->Attribute("name")});
  }
}

}  // namespace

std::set<std::string> noteAutolimits(const XMLElement& root) {
  for (auto* e = root.FirstChildElement("compiler"); e != nullptr;
       e = e->NextSiblingElement("compiler")) {
    if (optional(*e, "autolimits") == "false") {
      return {"autolimits=\"false\" of <compiler> (a range limits; write limited=\"false\")"};
    }
  }
  return {};
}

std::set<std::string> dropKeyframes(XMLElement* root) {
  std::set<std::string> notes;
  while (XMLElement* keyframe = root->FirstChildElement("keyframe")) {
    root->DeleteChild(keyframe);
    notes.insert("<keyframe> (it fits no world with robots)");
  }
  return notes;
}

void nameGeoms(XMLElement* body, const std::string& prefix, int* count) {
  for (auto* e = body->FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string kind = e->Name();
    if (kind == "geom" && e->Attribute("name") == nullptr) {
      e->SetAttribute("name", (prefix + "/geom_" + std::to_string((*count)++)).c_str());
    } else if (kind == "body") {
      nameGeoms(e, prefix, count);
    }
  }
}

std::shared_ptr<MjcfObject> readObject(const std::string& name, const std::string& text,
                                       const Pose& pose, double angle_unit,
                                       const ResourceResolver& resolve) {
  const std::string title = "Object '" + name + "'";
  if (name.empty()) {
    throw std::runtime_error("An object needs a name.");
  }
  auto object = std::make_shared<MjcfObject>();
  object->name = name;
  if (looksLikeSdf(text) || rootName(text) == "robot") {
    SdfScene scene = looksLikeSdf(text) ? readSdf(text, "", title, resolve, name)
                                        : readUrdfObject(text, name, resolve);
    object->aliases = writeSdf(&scene, angle_unit, false, &object->document).aliases;
    object->unsupported = scene.unsupported;
    int geoms = 0;
    nameGeoms(object->document.RootElement()->FirstChildElement("worldbody"), name, &geoms);
  } else {
    readMjcf(text, angle_unit, title, object.get());
  }
  place(object.get(), isometry(pose, title), title);
  return object;
}

void avoidNamesOf(const XMLElement& world, MjcfObject* object) {
  const MjcfNames taken = namesOf(world);
  const MjcfNames own = namesOf(*object->document.RootElement());
  const auto clash =
      std::find_if(own.begin(), own.end(), [&](const auto& name) { return taken.count(name) > 0; });
  if (clash == own.end()) {
    return;
  }
  const std::string prefix = object->name + "::";
  prefixNames(object->document.RootElement(), prefix);
  for (BodyAlias& alias : object->aliases) {
    alias.body = prefix + alias.body;
  }
  if (own.count({"body", object->name}) > 0) {
    object->aliases.push_back({object->name, prefix + object->name});
  }
  object->unsupported.insert("names of bodies, joints and other elements (the world has a " +
                             clash->first + " '" + clash->second + "' already: they begin with '" +
                             prefix + "' here)");
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

std::string withHeldJoints(const std::string& urdf) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.c_str(), urdf.size()) != tinyxml2::XML_SUCCESS) {
    return urdf;
  }
  auto* root = document.FirstChildElement("robot");
  std::set<std::string> notes;
  const bool held = root != nullptr && physics::holdJoints(root, "The robot description", &notes);
  return held ? physics::toText(document) : urdf;
}

}  // namespace franka_sim
