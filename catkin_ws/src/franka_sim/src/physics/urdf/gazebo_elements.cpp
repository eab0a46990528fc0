// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/urdf/gazebo_elements.h"

#include <optional>
#include <set>

#include "physics/mjcf/xml_util.h"
#include "physics/sdf/sdf_frames.h"
#include "physics/urdf/urdf_elements.h"

namespace franka_sim::physics {

using tinyxml2::XMLElement;

namespace {

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
    failAt(where, "<mu> needs one number that is not negative.");
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
        failAt(context, "<" + std::string(name) + "> must say true or false.");
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

}  // namespace

void readGazeboElements(const XMLElement& root, const std::string& context, UrdfRobot* robot) {
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

}  // namespace franka_sim::physics
