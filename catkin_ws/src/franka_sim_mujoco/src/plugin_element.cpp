// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "plugin_element.h"

#include <franka_core/numbers.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

namespace franka_sim_mujoco {

namespace {

using tinyxml2::XMLElement;

constexpr std::int64_t kMaxControlTicks = 1000;
/// Tolerance for decimal fractions that are not exact in binary [ticks].
constexpr double kRounding = 1e-6;

std::string childText(const XMLElement& element, const char* name) {
  const XMLElement* child = element.FirstChildElement(name);
  return child != nullptr && child->GetText() != nullptr ? child->GetText() : "";
}

std::string attributeText(const XMLElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value != nullptr ? value : "";
}

std::optional<PluginElement> readElement(const XMLElement& plugin) {
  PluginElement result;
  result.name = attributeText(plugin, "name");
  if (plugin.FirstChildElement("robotSimType") != nullptr) {
    result.hardware_type = childText(plugin, "robotSimType");
  } else if (attributeText(plugin, "filename").find("gazebo_ros_control") != std::string::npos) {
    result.hardware_type = "gazebo_ros_control/DefaultRobotHWSim";
  } else {
    return std::nullopt;
  }
  result.robot_namespace = childText(plugin, "robotNamespace");
  if (plugin.FirstChildElement("controlPeriod") != nullptr) {
    const std::string period = childText(plugin, "controlPeriod");
    const double ticks = 1e3 * franka_core::readNumber(period).value_or(0.0);
    const auto whole = franka_core::wholeNumber(std::round(ticks), 1, kMaxControlTicks);
    if (!whole || std::abs(ticks - std::round(ticks)) > kRounding) {
      throw std::runtime_error("The controlPeriod of the robot description is '" + period +
                               "'; it must be a time in seconds from 0.001 to 1, in whole "
                               "milliseconds: controllers run in ticks of the robot, which are 1 "
                               "ms long.");
    }
    result.control_ticks = static_cast<int>(*whole);
  }
  return result;
}

std::vector<PluginElement> readElements(const XMLElement& robot) {
  std::vector<PluginElement> elements;
  for (const auto* gazebo = robot.FirstChildElement("gazebo"); gazebo != nullptr;
       gazebo = gazebo->NextSiblingElement("gazebo")) {
    for (const auto* plugin = gazebo->FirstChildElement("plugin"); plugin != nullptr;
         plugin = plugin->NextSiblingElement("plugin")) {
      if (const auto element = readElement(*plugin)) {
        elements.push_back(*element);
      }
    }
  }
  return elements;
}

/// The arm_id of each transmission of the type franka_hw/FrankaStateInterface.
std::vector<std::string> armsIn(const XMLElement& robot) {
  constexpr char kFirstJoint[] = "_joint1";
  constexpr std::size_t kLength = sizeof(kFirstJoint) - 1;
  std::vector<std::string> arms;
  for (const auto* transmission = robot.FirstChildElement("transmission"); transmission != nullptr;
       transmission = transmission->NextSiblingElement("transmission")) {
    if (childText(*transmission, "type") != "franka_hw/FrankaStateInterface") {
      continue;
    }
    for (const auto* joint = transmission->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      const std::string name = attributeText(*joint, "name");
      if (name.size() <= kLength || name.substr(name.size() - kLength) != kFirstJoint) {
        continue;
      }
      const std::string arm_id = name.substr(0, name.size() - kLength);
      if (std::find(arms.begin(), arms.end(), arm_id) != arms.end()) {
        throw std::runtime_error(
            "The robot description has two transmissions of the type "
            "franka_hw/FrankaStateInterface for the arm '" +
            arm_id + "'.");
      }
      arms.push_back(arm_id);
    }
  }
  return arms;
}

bool isOfArm(const PluginElement& plugin) {
  return plugin.hardware_type.find("FrankaHWSim") != std::string::npos;
}

/// The namespace without slashes around it.
std::string namespaceOf(const PluginElement& plugin, const std::string& spawn_namespace) {
  const std::string& name =
      plugin.robot_namespace.empty() ? spawn_namespace : plugin.robot_namespace;
  const std::size_t begin = name.find_first_not_of('/');
  return begin == std::string::npos ? ""
                                    : name.substr(begin, name.find_last_not_of('/') + 1 - begin);
}

}  // namespace

PluginElement readPluginElement(const std::string& urdf, const std::string& spawn_namespace) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.c_str()) != tinyxml2::XML_SUCCESS || document.RootElement() == nullptr) {
    throw std::runtime_error("The robot description is not XML: " +
                             std::string(document.ErrorStr()));
  }
  const std::vector<PluginElement> elements = readElements(*document.RootElement());
  const auto of_arm = std::find_if(elements.begin(), elements.end(), isOfArm);
  PluginElement chosen;
  if (!elements.empty()) {
    chosen = of_arm != elements.end() ? *of_arm : elements.front();
  }
  if (chosen.hardware_type.empty() || isOfArm(chosen)) {
    chosen.arms = armsIn(*document.RootElement());
  }
  const std::string chosen_namespace = namespaceOf(chosen, spawn_namespace);
  for (const PluginElement& other : elements) {
    const std::string other_namespace = namespaceOf(other, spawn_namespace);
    if (other_namespace != chosen_namespace) {
      throw std::runtime_error(
          "The robot description has two plugins of ros_control, '" + chosen.name + "' (" +
          chosen.hardware_type + ") in the namespace /" + chosen_namespace + " and '" + other.name +
          "' (" + other.hardware_type + ") in /" + other_namespace +
          ". A robot has one controller manager: remove one of them; FrankaHWSim drives all "
          "joints with transmissions.");
    }
  }
  return chosen;
}

}  // namespace franka_sim_mujoco
