// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_gazebo/controller_verifier.h>

#include <algorithm>

namespace franka_gazebo {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

ControllerVerifier::ControllerVerifier(const std::map<std::string, std::shared_ptr<Joint>>& joints,
                                       const std::string& arm_id)
    : arm_id_(arm_id) {
  for (const auto& joint : joints) {
    joint_names_.insert(joint.first);
  }
}

bool ControllerVerifier::areArmJoints(const std::set<std::string>& resources) const {
  return std::all_of(resources.begin(), resources.end(), [this](const std::string& joint) {
    return joint_names_.count(joint) > 0 && !contains(joint, arm_id_ + "_finger_joint");
  });
}

bool ControllerVerifier::areFingerJoints(const std::set<std::string>& resources) const {
  return std::all_of(resources.begin(), resources.end(), [this](const std::string& joint) {
    return contains(joint, arm_id_ + "_finger_joint");
  });
}

bool ControllerVerifier::isValidController(
    const hardware_interface::ControllerInfo& controller) const {
  const auto& claims = controller.claimed_resources;
  return isClaimingGripperController(controller) || isClaimingArmController(controller) ||
         std::none_of(claims.begin(), claims.end(), [](const auto& claim) {
           return determineControlMethod(claim.hardware_interface).has_value();
         });
}

bool ControllerVerifier::isClaimingGripperController(
    const hardware_interface::ControllerInfo& controller) const {
  const auto& claims = controller.claimed_resources;
  return std::any_of(claims.begin(), claims.end(), [this](const auto& claim) {
    const auto method = determineControlMethod(claim.hardware_interface);
    return method && *method == EFFORT && claim.resources.size() == 2 &&
           areFingerJoints(claim.resources);
  });
}

bool ControllerVerifier::isClaimingArmController(
    const hardware_interface::ControllerInfo& controller) const {
  const auto& claims = controller.claimed_resources;
  const auto first = std::find_if(claims.begin(), claims.end(), [](const auto& claim) {
    return determineControlMethod(claim.hardware_interface) && claim.resources.size() == 7;
  });
  return first != claims.end() && areArmJoints(first->resources);
}

boost::optional<ControlMethod> ControllerVerifier::determineControlMethod(
    const std::string& hardware_interface) {
  if (contains(hardware_interface, "hardware_interface::PositionJointInterface")) {
    return POSITION;
  }
  if (contains(hardware_interface, "hardware_interface::VelocityJointInterface")) {
    return VELOCITY;
  }
  if (contains(hardware_interface, "hardware_interface::EffortJointInterface")) {
    return EFFORT;
  }
  return boost::none;
}

}  // namespace franka_gazebo
