// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <ros/console.h>
#include <transmission_interface/transmission_loader.h>

#include <cmath>
#include <locale>
#include <sstream>

namespace transmission_interface {

namespace {

bool hasSize(const char* what, std::size_t size, unsigned int expected,
             const TransmissionInfo& info) {
  if (size == expected) {
    return true;
  }
  ROS_ERROR_STREAM("Invalid description for transmission '"
                   << info.name_ << "' of type '" << info.type_ << "': expected " << expected << " "
                   << what << "(s), got " << size << ".");
  return false;
}

/// Location of an element in the description, for messages.
struct Place {
  const char* kind;  // "Joint" or "Actuator"
  const std::string& name;
  const std::string& transmission;
};

std::ostream& operator<<(std::ostream& out, const Place& place) {
  return out << place.kind << " '" << place.name << "' of transmission '" << place.transmission
             << "'";
}

/// The text of a child; nullptr if there is no such child.
const TiXmlElement* child(const TiXmlElement& parent, const char* tag, const Place& place,
                          bool required) {
  const TiXmlElement* element = parent.FirstChildElement(tag);
  if (element == nullptr && required) {
    ROS_ERROR_STREAM(place << " does not specify the required <" << tag << "> element.");
  }
  return element;
}

std::string textOf(const TiXmlElement& element) {
  const char* text = element.GetText();
  return text == nullptr ? std::string() : std::string(text);
}

// Independent of the locale: a URDF uses a decimal point.
bool readNumber(const std::string& text, double& number) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  double value = 0.0;
  if (!(stream >> value) || !(stream >> std::ws).eof() || !std::isfinite(value)) {
    return false;
  }
  number = value;
  return true;
}

}  // namespace

bool TransmissionLoader::checkActuatorDimension(const TransmissionInfo& transmission_info,
                                                const unsigned int expected_dim) {
  return hasSize("actuator", transmission_info.actuators_.size(), expected_dim, transmission_info);
}

bool TransmissionLoader::checkJointDimension(const TransmissionInfo& transmission_info,
                                             const unsigned int expected_dim) {
  return hasSize("joint", transmission_info.joints_.size(), expected_dim, transmission_info);
}

TiXmlElement TransmissionLoader::loadXmlElement(const std::string& element_str) {
  TiXmlDocument document;
  document.Parse(element_str.c_str());
  const TiXmlElement* root = document.RootElement();
  if (document.Error() || root == nullptr) {
    ROS_ERROR_STREAM("Part of a transmission's description is not valid XML: '" << element_str
                                                                                << "'.");
    return TiXmlElement("");
  }
  return *root;
}

namespace {

template <class Status>
Status number(const TiXmlElement& parent, const char* tag, const Place& place, bool required,
              double& value, Status success, Status no_data, Status bad_type) {
  const TiXmlElement* element = child(parent, tag, place, required);
  if (element == nullptr) {
    return no_data;
  }
  if (!readNumber(textOf(*element), value)) {
    ROS_ERROR_STREAM(place << " has '" << textOf(*element) << "' as its <" << tag
                           << ">, which is not a finite number.");
    return bad_type;
  }
  return success;
}

template <class Status>
Status word(const TiXmlElement& parent, const char* tag, const Place& place, bool required,
            std::string& value, Status success, Status no_data, Status bad_type) {
  const TiXmlElement* element = child(parent, tag, place, required);
  if (element == nullptr) {
    return no_data;
  }
  if (textOf(*element).empty()) {
    ROS_ERROR_STREAM(place << " has an empty <" << tag << "> element.");
    return bad_type;
  }
  value = textOf(*element);
  return success;
}

}  // namespace

TransmissionLoader::ParseStatus TransmissionLoader::getActuatorReduction(
    const TiXmlElement& parent_el, const std::string& actuator_name,
    const std::string& transmission_name, bool required, double& reduction) {
  return number(parent_el, "mechanicalReduction", {"Actuator", actuator_name, transmission_name},
                required, reduction, SUCCESS, NO_DATA, BAD_TYPE);
}

TransmissionLoader::ParseStatus TransmissionLoader::getJointReduction(
    const TiXmlElement& parent_el, const std::string& joint_name,
    const std::string& transmission_name, bool required, double& reduction) {
  return number(parent_el, "mechanicalReduction", {"Joint", joint_name, transmission_name},
                required, reduction, SUCCESS, NO_DATA, BAD_TYPE);
}

TransmissionLoader::ParseStatus TransmissionLoader::getJointOffset(
    const TiXmlElement& parent_el, const std::string& joint_name,
    const std::string& transmission_name, bool required, double& offset) {
  return number(parent_el, "offset", {"Joint", joint_name, transmission_name}, required, offset,
                SUCCESS, NO_DATA, BAD_TYPE);
}

TransmissionLoader::ParseStatus TransmissionLoader::getActuatorRole(
    const TiXmlElement& parent_el, const std::string& actuator_name,
    const std::string& transmission_name, bool required, std::string& role) {
  return word(parent_el, "role", {"Actuator", actuator_name, transmission_name}, required, role,
              SUCCESS, NO_DATA, BAD_TYPE);
}

TransmissionLoader::ParseStatus TransmissionLoader::getJointRole(
    const TiXmlElement& parent_el, const std::string& joint_name,
    const std::string& transmission_name, bool required, std::string& role) {
  return word(parent_el, "role", {"Joint", joint_name, transmission_name}, required, role, SUCCESS,
              NO_DATA, BAD_TYPE);
}

}  // namespace transmission_interface
