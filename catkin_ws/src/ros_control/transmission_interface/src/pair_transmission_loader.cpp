// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <ros/console.h>
#include <transmission_interface/detail/pair_transmission_loader.h>

#include <cstddef>

namespace transmission_interface {
namespace internal {

namespace {

/// Index of a role: 0 or 1. @returns false, with a sentence, for other roles, and for a duplicate.
bool placeOf(const std::string& role, const std::string& base, const std::string& owner,
             const std::string& transmission, bool (&taken)[2], std::size_t& place) {
  if (role != base + "1" && role != base + "2") {
    ROS_ERROR_STREAM("'" << owner << "' of transmission '" << transmission << "' has the role '"
                         << role << "'. Valid roles are '" << base << "1' and '" << base << "2'.");
    return false;
  }
  place = role == base + "1" ? 0 : 1;
  if (taken[place]) {
    ROS_ERROR_STREAM("Transmission '" << transmission << "' gives the role '" << role
                                      << "' twice. Give '" << owner << "' the other one.");
    return false;
  }
  taken[place] = true;
  return true;
}

/// Whether a joint's encoder is behind the transmission: by the element, unless it contains
/// "false".
bool ignoresAbsoluteEncoder(const TiXmlElement& joint) {
  const TiXmlElement* element = joint.FirstChildElement("ignoreTransmissionAbsoluteEncoder");
  if (element == nullptr) {
    return false;
  }
  const char* text = element->GetText();
  return text == nullptr || std::string(text) != "false";
}

}  // namespace

bool PairTransmissionLoader::readConfig(const TransmissionInfo& info, Config& config) {
  return checkActuatorDimension(info, 2) && checkJointDimension(info, 2) &&
         readActuators(info, config) && readJoints(info, config);
}

bool PairTransmissionLoader::readActuators(const TransmissionInfo& info, Config& config) {
  bool taken[2] = {false, false};
  for (const ActuatorInfo& actuator : info.actuators_) {
    const TiXmlElement element = loadXmlElement(actuator.xml_element_);
    std::string role;
    std::size_t place = 0;
    if (getActuatorRole(element, actuator.name_, info.name_, true, role) != SUCCESS ||
        !placeOf(role, "actuator", actuator.name_, info.name_, taken, place) ||
        getActuatorReduction(element, actuator.name_, info.name_, true,
                             config.actuator_reduction[place]) != SUCCESS) {
      return false;
    }
  }
  return true;
}

bool PairTransmissionLoader::readJoints(const TransmissionInfo& info, Config& config) {
  bool taken[2] = {false, false};
  int ignoring = 0;
  for (const JointInfo& joint : info.joints_) {
    const TiXmlElement element = loadXmlElement(joint.xml_element_);
    std::string role;
    std::size_t place = 0;
    if (getJointRole(element, joint.name_, info.name_, true, role) != SUCCESS ||
        !placeOf(role, "joint", joint.name_, info.name_, taken, place) ||
        getJointReduction(element, joint.name_, info.name_, false, config.joint_reduction[place]) ==
            BAD_TYPE ||
        getJointOffset(element, joint.name_, info.name_, false, config.joint_offset[place]) ==
            BAD_TYPE) {
      return false;
    }
    ignoring += ignoresAbsoluteEncoder(element) ? 1 : 0;
  }
  if (ignoring == 1) {
    ROS_WARN_STREAM("Only one joint of transmission '"
                    << info.name_ << "' has <ignoreTransmissionAbsoluteEncoder/>. It counts only "
                    << "where both have it, so it is ignored.");
  }
  config.ignores_absolute_encoders = ignoring == 2;
  return true;
}

}  // namespace internal
}  // namespace transmission_interface
