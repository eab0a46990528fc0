// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <ros/console.h>
#include <transmission_interface/transmission_parser.h>

#include <utility>

namespace transmission_interface {

namespace {

std::string textOf(const TiXmlElement& element) {
  const char* text = element.GetText();
  return text == nullptr ? std::string() : std::string(text);
}

std::string attribute(const TiXmlElement& element, const char* name) {
  const char* value = element.Attribute(name);
  return value == nullptr ? std::string() : std::string(value);
}

std::string serialized(const TiXmlElement& element) {
  TiXmlPrinter printer;
  element.Accept(&printer);
  return printer.CStr();
}

std::vector<std::string> hardwareInterfaces(TiXmlElement& owner, const std::string& owner_name) {
  std::vector<std::string> interfaces;
  for (TiXmlElement* it = owner.FirstChildElement("hardwareInterface"); it != nullptr;
       it = it->NextSiblingElement("hardwareInterface")) {
    const std::string name = textOf(*it);
    if (name.empty()) {
      ROS_ERROR_STREAM("Empty <hardwareInterface> element in '"
                       << owner_name << "' of the robot description: left out. Write the name of "
                       << "an interface between its tags.");
    } else {
      interfaces.push_back(name);
    }
  }
  return interfaces;
}

enum class NameStatus { kGood, kEmpty, kMissing };

/// Same rule for joints and actuators: a missing name invalidates the transmission, an empty name
/// only the element.
NameStatus readName(const TiXmlElement& element, const char* kind, std::string& name) {
  if (element.Attribute("name") == nullptr) {
    ROS_ERROR("No name attribute for an element <%s> of a transmission: give it one.", kind);
    return NameStatus::kMissing;
  }
  name = attribute(element, "name");
  if (name.empty()) {
    ROS_ERROR("Empty name attribute for an element <%s> of a transmission: left out.", kind);
    return NameStatus::kEmpty;
  }
  return NameStatus::kGood;
}

}  // namespace

bool TransmissionParser::parse(const std::string& urdf_string,
                               std::vector<TransmissionInfo>& transmissions) {
  TiXmlDocument document;
  document.Parse(urdf_string.c_str());
  TiXmlElement* root = document.RootElement();
  // A text with only a comment is valid and has no root.
  if (document.Error() || root == nullptr) {
    ROS_ERROR("Can't parse transmissions. Invalid robot description.");
    return false;
  }

  for (TiXmlElement* it = root->FirstChildElement("transmission"); it != nullptr;
       it = it->NextSiblingElement("transmission")) {
    TransmissionInfo transmission;
    transmission.name_ = attribute(*it, "name");
    if (transmission.name_.empty()) {
      ROS_ERROR("Transmission without a name in the robot description: left out.");
      continue;
    }
    const TiXmlElement* type = it->FirstChildElement("type");
    transmission.type_ = type == nullptr ? std::string() : textOf(*type);
    if (transmission.type_.empty()) {
      ROS_ERROR_STREAM("Transmission '" << transmission.name_
                                        << "' has no <type>, or an empty one: left out.");
      continue;
    }
    if (!parseJoints(it, transmission.joints_)) {
      ROS_ERROR_STREAM("Transmission '" << transmission.name_
                                        << "' has no joint that could be used: left out.");
      continue;
    }
    if (!parseActuators(it, transmission.actuators_)) {
      ROS_ERROR_STREAM("Transmission '" << transmission.name_
                                        << "' has no actuator that could be used: left out.");
      continue;
    }
    transmissions.push_back(std::move(transmission));
  }
  if (transmissions.empty()) {
    ROS_DEBUG("No valid transmissions found.");
  }
  return true;
}

bool TransmissionParser::parseJoints(TiXmlElement* trans_it, std::vector<JointInfo>& joints) {
  for (TiXmlElement* it = trans_it->FirstChildElement("joint"); it != nullptr;
       it = it->NextSiblingElement("joint")) {
    JointInfo joint;
    const NameStatus status = readName(*it, "joint", joint.name_);
    if (status == NameStatus::kMissing) {
      return false;
    }
    if (status == NameStatus::kEmpty) {
      continue;
    }
    joint.hardware_interfaces_ = hardwareInterfaces(*it, joint.name_);
    if (joint.hardware_interfaces_.empty()) {
      ROS_ERROR_STREAM("Joint '" << joint.name_ << "' of a transmission has no valid "
                                 << "<hardwareInterface> element: left out.");
      continue;
    }
    const TiXmlElement* role = it->FirstChildElement("role");
    if (role != nullptr) {
      joint.role_ = textOf(*role);
    }
    joint.xml_element_ = serialized(*it);
    joints.push_back(std::move(joint));
  }
  return !joints.empty();
}

bool TransmissionParser::parseActuators(TiXmlElement* trans_it,
                                        std::vector<ActuatorInfo>& actuators) {
  for (TiXmlElement* it = trans_it->FirstChildElement("actuator"); it != nullptr;
       it = it->NextSiblingElement("actuator")) {
    ActuatorInfo actuator;
    const NameStatus status = readName(*it, "actuator", actuator.name_);
    if (status == NameStatus::kMissing) {
      return false;
    }
    if (status == NameStatus::kEmpty) {
      continue;
    }
    actuator.hardware_interfaces_ = hardwareInterfaces(*it, actuator.name_);
    actuator.xml_element_ = serialized(*it);
    actuators.push_back(std::move(actuator));
  }
  return !actuators.empty();
}

}  // namespace transmission_interface
