// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "controller_check.h"

#include <franka_hw/resource_helpers.h>
#include <hardware_interface/robot_hw.h>

#include <algorithm>
#include <utility>

namespace franka_sim_mujoco {

namespace {

using franka_hw::ControlMode;
using hardware_interface::ControllerInfo;
using Names = std::set<std::string>;

constexpr char kEffort[] = "hardware_interface::EffortJointInterface";
constexpr std::size_t kArmJoints = 7;

struct Interface {
  const char* name;
  ControlMode mode;
  bool cartesian;
};

constexpr Interface kInterfaces[] = {
    {kEffort, ControlMode::JointTorque, false},
    {"hardware_interface::PositionJointInterface", ControlMode::JointPosition, false},
    {"hardware_interface::VelocityJointInterface", ControlMode::JointVelocity, false},
    {"franka_hw::FrankaPoseCartesianInterface", ControlMode::CartesianPose, true},
    {"franka_hw::FrankaVelocityCartesianInterface", ControlMode::CartesianVelocity, true},
};

const Interface* interfaceOf(const std::string& name) noexcept {
  for (const Interface& known : kInterfaces) {
    if (name == known.name) {
      return &known;
    }
  }
  return nullptr;
}

bool begins(const std::string& text, const std::string& beginning) noexcept {
  return text.compare(0, beginning.size(), beginning) == 0;
}

bool isArmJoint(const std::string& resource, const std::string& arm_id) noexcept {
  static constexpr char kJoint[] = "_joint";
  const std::size_t prefix = arm_id.size() + sizeof(kJoint) - 1;
  return resource.size() == prefix + 1 && begins(resource, arm_id) &&
         resource.compare(arm_id.size(), sizeof(kJoint) - 1, kJoint) == 0 &&
         resource[prefix] >= '1' && resource[prefix] <= '7';
}

bool isArm(const std::string& resource, const std::string& arm_id) noexcept {
  static constexpr char kRobot[] = "_robot";
  return resource.size() == arm_id.size() + sizeof(kRobot) - 1 && begins(resource, arm_id) &&
         resource.compare(arm_id.size(), std::string::npos, kRobot) == 0;
}

bool isFinger(const std::string& resource, const std::string& arm_id) {
  return resource == arm_id + "_finger_joint1" || resource == arm_id + "_finger_joint2";
}

std::string join(const Names& names) {
  std::string joined;
  for (const std::string& name : names) {
    joined += (joined.empty() ? "" : ", ") + name;
  }
  return joined;
}

std::string whyClaimRefused(const hardware_interface::InterfaceResources& claim,
                            const std::string& arm_id, const Names& others) {
  const Interface* interface = interfaceOf(claim.hardware_interface);
  if (interface == nullptr) {
    return "it claims " + claim.hardware_interface + ", which takes no commands here.";
  }
  const Names& names = claim.resources;
  const auto count = [&](auto predicate) {
    return static_cast<std::size_t>(std::count_if(names.begin(), names.end(), predicate));
  };
  const std::size_t arm_joints = count([&](const auto& name) { return isArmJoint(name, arm_id); });
  const std::size_t arms = count([&](const auto& name) { return isArm(name, arm_id); });
  const std::size_t fingers =
      count([&](const auto& name) { return isFinger(name, arm_id) && others.count(name) == 0; });
  const std::size_t rest = count([&](const auto& name) { return others.count(name) > 0; });
  if (interface->cartesian) {
    return arms == names.size()
               ? ""
               : "it claims " + join(names) + " through " + claim.hardware_interface +
                     ", which moves " + arm_id + "_robot alone.";
  }
  if (fingers > 0 && claim.hardware_interface != kEffort) {
    return "it claims fingers through " + claim.hardware_interface + ", but they take only " +
           kEffort + " commands.";
  }
  const bool whole = (arm_joints == 0 || arm_joints == kArmJoints) &&
                     (fingers == 0 || (fingers == 2 && arm_joints == 0));
  if (!whole || arm_joints + fingers + rest != names.size()) {
    return "it claims " + join(names) + ", but a controller must claim either all of " + arm_id +
           "_joint1 to 7 or both of " + arm_id + "_finger_joint1 and 2.";
  }
  return "";
}

ControlMode claimedMode(const ControllerInfo& controller, const std::string& arm_id) noexcept {
  ControlMode mode = ControlMode::None;
  for (const auto& claim : controller.claimed_resources) {
    const Interface* interface = interfaceOf(claim.hardware_interface);
    const auto of_arm = [&](const std::string& name) {
      return isArmJoint(name, arm_id) || isArm(name, arm_id);
    };
    if (interface != nullptr &&
        std::any_of(claim.resources.begin(), claim.resources.end(), of_arm)) {
      mode |= interface->mode;
    }
  }
  return mode;
}

/// The controllers with those of their claimed resources that belong to the arm, or that do not.
std::list<ControllerInfo> part(const std::list<ControllerInfo>& controllers,
                               const std::string& arm_id, bool of_arm) {
  std::list<ControllerInfo> result;
  for (ControllerInfo controller : controllers) {
    for (auto& claim : controller.claimed_resources) {
      Names kept;
      for (const std::string& name : claim.resources) {
        if ((isArmJoint(name, arm_id) || isArm(name, arm_id)) == of_arm) {
          kept.insert(name);
        }
      }
      claim.resources = std::move(kept);
    }
    result.push_back(std::move(controller));
  }
  return result;
}

}  // namespace

std::string whyRefused(const ControllerInfo& controller, const std::string& arm_id,
                       const Names& others) {
  for (const auto& claim : controller.claimed_resources) {
    if (claim.resources.empty()) {
      continue;
    }
    const std::string reason = whyClaimRefused(claim, arm_id, others);
    if (!reason.empty()) {
      return "The controller '" + controller.name + "' cannot run on the simulated arm '" + arm_id +
             "': " + reason;
    }
  }
  return "";
}

bool conflict(const std::list<ControllerInfo>& controllers, const std::string& arm_id) {
  franka_hw::ResourceWithClaimsMap resources =
      franka_hw::getResourceMap(part(controllers, arm_id, true));
  if (franka_hw::hasConflictingMultiClaim(resources)) {
    return true;
  }
  franka_hw::ArmClaimedMap claims;
  if (!franka_hw::getArmClaimedMap(resources, claims) ||
      franka_hw::hasConflictingJointAndCartesianClaim(claims, arm_id) ||
      franka_hw::partiallyClaimsArmJoints(claims, arm_id)) {
    return true;
  }
  return hardware_interface::RobotHW().checkForConflict(part(controllers, arm_id, false));
}

bool commandsArm(const ControllerInfo& controller, const std::string& arm_id) noexcept {
  return claimedMode(controller, arm_id) != ControlMode::None;
}

ControlMode claimedMode(const std::list<ControllerInfo>& controllers,
                        const std::string& arm_id) noexcept {
  ControlMode mode = ControlMode::None;
  for (const ControllerInfo& controller : controllers) {
    mode |= claimedMode(controller, arm_id);
  }
  return mode;
}

}  // namespace franka_sim_mujoco
