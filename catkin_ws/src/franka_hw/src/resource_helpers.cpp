// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/resource_helpers.h>
#include <ros/console.h>

#include <algorithm>
#include <array>
#include <utility>

namespace franka_hw {

namespace {

constexpr char kEffortInterface[] = "hardware_interface::EffortJointInterface";
constexpr uint8_t kJointsOfAnArm = 7;

/// Index of the interface in one claim of a ResourceWithClaimsMap.
constexpr std::size_t kInterfaceIndex = 2;

/// The counter of an interface type; nullptr for interfaces that a Franka arm does not have.
uint8_t* counterOf(const std::string& interface_type, ResourceClaims& claims) {
  if (interface_type == kEffortInterface) {
    return &claims.joint_torque_claims;
  }
  if (interface_type == "hardware_interface::PositionJointInterface") {
    return &claims.joint_position_claims;
  }
  if (interface_type == "hardware_interface::VelocityJointInterface") {
    return &claims.joint_velocity_claims;
  }
  if (interface_type == "franka_hw::FrankaPoseCartesianInterface") {
    return &claims.cartesian_pose_claims;
  }
  if (interface_type == "franka_hw::FrankaVelocityCartesianInterface") {
    return &claims.cartesian_velocity_claims;
  }
  return nullptr;
}

ResourceClaims claimsOf(const ArmClaimedMap& arm_claim_map, const std::string& arm_id) {
  const auto found = arm_claim_map.find(arm_id);
  return found == arm_claim_map.end() ? ResourceClaims{} : found->second;
}

}  // namespace

bool findArmIdInResourceId(const std::string& resource_id, std::string* arm_id) {
  for (const char* marker : {"_joint", "_robot"}) {
    const std::size_t position = resource_id.rfind(marker);
    if (position != std::string::npos && position > 0) {
      *arm_id = resource_id.substr(0, position);
      return true;
    }
  }
  return false;
}

ResourceWithClaimsMap getResourceMap(const std::list<hardware_interface::ControllerInfo>& info) {
  ResourceWithClaimsMap resource_map;
  for (const auto& controller : info) {
    for (const auto& claimed : controller.claimed_resources) {
      for (const auto& resource : claimed.resources) {
        resource_map[resource].push_back(
            {controller.name, controller.type, claimed.hardware_interface});
      }
    }
  }
  return resource_map;
}

bool getArmClaimedMap(ResourceWithClaimsMap& resource_map, ArmClaimedMap& arm_claim_map) {
  for (const auto& [resource, claims] : resource_map) {
    std::string arm_id;
    if (!findArmIdInResourceId(resource, &arm_id)) {
      ROS_ERROR(
          "The resource '%s' belongs to no arm: its name must read <arm_id>_joint<N> or "
          "<arm_id>_robot.",
          resource.c_str());
      return false;
    }
    ResourceClaims& arm_claims = arm_claim_map[arm_id];
    for (const auto& claim : claims) {
      uint8_t* counter = counterOf(claim.at(kInterfaceIndex), arm_claims);
      if (counter == nullptr) {
        ROS_ERROR("Controller '%s' claims '%s' through %s, which a Franka arm does not offer.",
                  claim.front().c_str(), resource.c_str(), claim.at(kInterfaceIndex).c_str());
        return false;
      }
      ++*counter;
    }
  }
  return true;
}

ControlMode getControlMode(const std::string& arm_id, ArmClaimedMap& arm_claim_map) {
  const ResourceClaims claims = claimsOf(arm_claim_map, arm_id);
  const std::array<std::pair<uint8_t, ControlMode>, 4> generators{{
      {claims.joint_position_claims, ControlMode::JointPosition},
      {claims.joint_velocity_claims, ControlMode::JointVelocity},
      {claims.cartesian_pose_claims, ControlMode::CartesianPose},
      {claims.cartesian_velocity_claims, ControlMode::CartesianVelocity},
  }};
  ControlMode mode = ControlMode::None;
  for (const auto& [count, generator] : generators) {
    if (count == 0) {
      continue;
    }
    if (mode != ControlMode::None) {
      return ControlMode::None;  // two motion generators at the same time
    }
    mode = generator;
  }
  return claims.joint_torque_claims > 0 ? mode | ControlMode::JointTorque : mode;
}

bool hasConflictingMultiClaim(const ResourceWithClaimsMap& resource_map) {
  for (const auto& [resource, claims] : resource_map) {
    if (claims.size() < 2) {
      continue;
    }
    const auto torque_claims = std::count_if(claims.begin(), claims.end(), [](const auto& claim) {
      return claim.at(kInterfaceIndex) == kEffortInterface;
    });
    if (claims.size() > 2 || torque_claims != 1) {
      ROS_ERROR(
          "The resource '%s' is claimed %zu times; only one motion and one torque controller "
          "can share it.",
          resource.c_str(), claims.size());
      return true;
    }
  }
  return false;
}

bool hasConflictingJointAndCartesianClaim(const ArmClaimedMap& arm_claim_map,
                                          const std::string& arm_id) {
  const ResourceClaims claims = claimsOf(arm_claim_map, arm_id);
  const bool cartesian = claims.cartesian_pose_claims + claims.cartesian_velocity_claims > 0;
  const bool joint = claims.joint_position_claims + claims.joint_velocity_claims > 0;
  if (cartesian && joint) {
    ROS_ERROR(
        "Arm '%s' cannot follow joint and Cartesian commands at once; start one or the other.",
        arm_id.c_str());
  }
  return cartesian && joint;
}

bool partiallyClaimsArmJoints(const ArmClaimedMap& arm_claim_map, const std::string& arm_id) {
  const ResourceClaims claims = claimsOf(arm_claim_map, arm_id);
  for (uint8_t count :
       {claims.joint_position_claims, claims.joint_velocity_claims, claims.joint_torque_claims}) {
    if (count > 0 && count != kJointsOfAnArm) {
      ROS_ERROR(
          "Controllers claim %d joints of arm '%s' through one interface; a controller must "
          "claim all seven.",
          static_cast<int>(count), arm_id.c_str());
      return true;
    }
  }
  return false;
}

bool hasTrajectoryClaim(const ArmClaimedMap& arm_claim_map, const std::string& arm_id) {
  const ResourceClaims claims = claimsOf(arm_claim_map, arm_id);
  return claims.joint_position_claims + claims.joint_velocity_claims +
             claims.cartesian_pose_claims + claims.cartesian_velocity_claims >
         0;
}

}  // namespace franka_hw
