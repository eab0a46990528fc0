// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/control_mode.h>
#include <hardware_interface/controller_info.h>

#include <cstdint>
#include <list>
#include <map>
#include <string>
#include <vector>

namespace franka_hw {

/// @file
/// The rules by which controllers may share an arm. Called when controllers are switched, outside
/// the loop; every function is free of side effects except for log lines that name what is refused.

/// Resource name -> every claim on it, each as {controller name, controller type, interface type}.
using ResourceWithClaimsMap = std::map<std::string, std::vector<std::vector<std::string>>>;

/// How often each kind of command is claimed on one arm.
struct ResourceClaims {
  uint8_t joint_position_claims = 0;
  uint8_t joint_velocity_claims = 0;
  uint8_t joint_torque_claims = 0;
  uint8_t cartesian_velocity_claims = 0;
  uint8_t cartesian_pose_claims = 0;
};

/// arm_id -> claims on that arm.
using ArmClaimedMap = std::map<std::string, ResourceClaims>;

/// Finds the arm a resource belongs to: what stands before the last `_joint`, else before the last
/// `_robot`. @returns false, leaving *arm_id alone, when there is neither or nothing stands before
/// it.
bool findArmIdInResourceId(const std::string& resource_id, std::string* arm_id);

/// Turns the controllers' claims round: who claims what becomes what is claimed by whom.
ResourceWithClaimsMap getResourceMap(const std::list<hardware_interface::ControllerInfo>& info);

/// Counts the claims on each arm. @returns false, after saying which, when a resource belongs to no
/// arm or is claimed through an interface a Franka arm does not have.
bool getArmClaimedMap(ResourceWithClaimsMap& resource_map, ArmClaimedMap& arm_claim_map);

/// The control mode that the claims on one arm ask for; None for no claims and for combinations
/// that no robot can run.
ControlMode getControlMode(const std::string& arm_id, ArmClaimedMap& arm_claim_map);

/// True when one resource has more than two claims, or two of which not exactly one is on torques.
bool hasConflictingMultiClaim(const ResourceWithClaimsMap& resource_map);

/// True when position or velocity is claimed both on the joints and on the Cartesian pose of one
/// arm.
bool hasConflictingJointAndCartesianClaim(const ArmClaimedMap& arm_claim_map,
                                          const std::string& arm_id);

/// True when a joint interface is claimed on some, but not all seven joints of one arm.
bool partiallyClaimsArmJoints(const ArmClaimedMap& arm_claim_map, const std::string& arm_id);

/// True when anything but torques is claimed on one arm.
bool hasTrajectoryClaim(const ArmClaimedMap& arm_claim_map, const std::string& arm_id);

}  // namespace franka_hw
