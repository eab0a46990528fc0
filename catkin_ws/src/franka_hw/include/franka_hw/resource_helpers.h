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
/// the loop. The functions have no side effects except log lines that name what is refused.

/// Resource name -> every claim on it, each as {controller name, controller type, interface type}.
using ResourceWithClaimsMap = std::map<std::string, std::vector<std::vector<std::string>>>;

/// How often each kind of command is claimed on one arm.
struct ResourceClaims {
  uint8_t joint_position_claims = 0;      ///< number of claims
  uint8_t joint_velocity_claims = 0;      ///< number of claims
  uint8_t joint_torque_claims = 0;        ///< number of claims
  uint8_t cartesian_velocity_claims = 0;  ///< number of claims
  uint8_t cartesian_pose_claims = 0;      ///< number of claims
};

/// arm_id -> claims on that arm.
using ArmClaimedMap = std::map<std::string, ResourceClaims>;

/// Finds the arm of a resource: the text before the last `_joint`, otherwise before the last
/// `_robot`. @returns false, without a change of *arm_id, if there is neither or the text before it
/// is empty.
bool findArmIdInResourceId(const std::string& resource_id, std::string* arm_id);

/// Converts the claims per controller into controllers per claimed resource.
ResourceWithClaimsMap getResourceMap(const std::list<hardware_interface::ControllerInfo>& info);

/// Counts the claims on each arm. @returns false, after logging which resource, if a resource
/// belongs to no arm or is claimed through an interface that a Franka arm does not have.
bool getArmClaimedMap(ResourceWithClaimsMap& resource_map, ArmClaimedMap& arm_claim_map);

/// The control mode for the claims on one arm; None for no claims and for combinations that no
/// robot can run.
ControlMode getControlMode(const std::string& arm_id, ArmClaimedMap& arm_claim_map);

/// True if one resource has more than two claims, or two claims of which not exactly one is on
/// torques.
bool hasConflictingMultiClaim(const ResourceWithClaimsMap& resource_map);

/// True if position or velocity is claimed both on the joints and on the Cartesian pose of one arm.
bool hasConflictingJointAndCartesianClaim(const ArmClaimedMap& arm_claim_map,
                                          const std::string& arm_id);

/// True if a joint interface is claimed on some, but not all seven joints of one arm.
bool partiallyClaimsArmJoints(const ArmClaimedMap& arm_claim_map, const std::string& arm_id);

/// True if an interface other than torques is claimed on one arm.
bool hasTrajectoryClaim(const ArmClaimedMap& arm_claim_map, const std::string& arm_id);

}  // namespace franka_hw
