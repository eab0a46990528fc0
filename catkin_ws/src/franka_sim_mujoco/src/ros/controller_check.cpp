// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/ros/controller_check.h>

#include <algorithm>
#include <set>

namespace franka_sim_mujoco {

namespace {

constexpr char kEffort[] = "hardware_interface::EffortJointInterface";

bool isArmJoint(const std::string& resource, const std::string& arm_id) noexcept {
  static constexpr char kJoint[] = "_joint";
  const std::size_t prefix = arm_id.size() + sizeof(kJoint) - 1;
  return resource.size() == prefix + 1 && resource.compare(0, arm_id.size(), arm_id) == 0 &&
         resource.compare(arm_id.size(), sizeof(kJoint) - 1, kJoint) == 0 &&
         resource[prefix] >= '1' && resource[prefix] <= '7';
}

bool isFinger(const std::string& resource, const std::string& arm_id) {
  return resource == arm_id + "_finger_joint1" || resource == arm_id + "_finger_joint2";
}

std::string join(const std::set<std::string>& names) {
  std::string joined;
  for (const std::string& name : names) {
    joined += (joined.empty() ? "" : ", ") + name;
  }
  return joined;
}

}  // namespace

std::string whyRefused(const hardware_interface::ControllerInfo& controller,
                       const std::string& arm_id) {
  const std::string who =
      "The controller '" + controller.name + "' cannot run on the simulated arm '" + arm_id + "': ";
  for (const auto& claim : controller.claimed_resources) {
    if (claim.resources.empty()) {
      continue;
    }
    if (claim.hardware_interface != kEffort) {
      return who + "it claims " + claim.hardware_interface + ", but only " + kEffort +
             " commands are simulated.";
    }
    const auto is_arm = [&](const std::string& name) { return isArmJoint(name, arm_id); };
    const auto is_finger = [&](const std::string& name) { return isFinger(name, arm_id); };
    const auto all = [&](auto predicate, std::size_t count) {
      return claim.resources.size() == count &&
             std::all_of(claim.resources.begin(), claim.resources.end(), predicate);
    };
    if (!all(is_arm, 7) && !all(is_finger, 2)) {
      return who + "it claims " + join(claim.resources) +
             ", but a controller must claim either all of " + arm_id + "_joint1 to 7 or both of " +
             arm_id + "_finger_joint1 and 2.";
    }
  }
  return "";
}

bool commandsArm(const hardware_interface::ControllerInfo& controller,
                 const std::string& arm_id) noexcept {
  for (const auto& claim : controller.claimed_resources) {
    for (const std::string& resource : claim.resources) {
      if (isArmJoint(resource, arm_id)) {
        // The read-only interfaces never appear among the claims.
        return true;
      }
    }
  }
  return false;
}

bool anyCommandsArm(const std::list<hardware_interface::ControllerInfo>& controllers,
                    const std::string& arm_id) noexcept {
  return std::any_of(controllers.begin(), controllers.end(),
                     [&](const auto& controller) { return commandsArm(controller, arm_id); });
}

}  // namespace franka_sim_mujoco
