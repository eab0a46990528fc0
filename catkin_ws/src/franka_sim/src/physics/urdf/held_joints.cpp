// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/urdf/held_joints.h"

#include <franka_sim/physics/world.h>

#include <Eigen/Geometry>
#include <map>
#include <optional>

#include "physics/mjcf/xml_util.h"
#include "physics/urdf/urdf_elements.h"

namespace franka_sim::physics {

using tinyxml2::XMLElement;

namespace {

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
      axis == nullptr ? Eigen::Vector3d(1, 0, 0) : readVector(*axis, "xyz", {1, 0, 0}, where);
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

}  // namespace franka_sim::physics

namespace franka_sim {

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
