// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/mjcf/mjcf_object.h"

#include <franka_sim/physics/pose_conversions.h>
#include <franka_sim/physics/world.h>

#include <algorithm>
#include <stdexcept>

#include "physics/engine/model_compiler.h"
#include "physics/engine/model_data.h"
#include "physics/engine/rotations.h"
#include "physics/mjcf/mjcf_files.h"
#include "physics/mjcf/mjcf_names.h"
#include "physics/mjcf/xml_util.h"
#include "physics/sdf/sdf_scene.h"
#include "physics/urdf/urdf_object.h"

namespace franka_sim::physics {
namespace {

using tinyxml2::XMLElement;

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
