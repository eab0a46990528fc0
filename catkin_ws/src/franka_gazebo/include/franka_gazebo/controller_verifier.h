// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/controller_info.h>

#include <boost/optional.hpp>
#include <map>
#include <memory>
#include <set>
#include <string>

namespace franka_gazebo {

struct Joint;

/// Quantity that commands a joint.
enum ControlMethod { EFFORT, POSITION, VELOCITY };

constexpr const char* kRobotJointSuffixes[] = {"_joint1", "_joint2",        "_joint3",
                                               "_joint4", "_joint5",        "_joint6",
                                               "_joint7", "_finger_joint1", "_finger_joint2"};

/// Interprets a controller's claims for an arm with a hand, by the original's rules. The simulation
/// itself allows more (controller_check.h of franka_sim_mujoco). Functions have no side effects.
class ControllerVerifier {
 public:
  /// @param joints of the robot, by name
  ControllerVerifier(const std::map<std::string, std::shared_ptr<Joint>>& joints,
                     const std::string& arm_id);

  /// Whether all are joints of the robot and none is a finger's.
  bool areArmJoints(const std::set<std::string>& resources) const;
  /// Whether all are the fingers' joints.
  bool areFingerJoints(const std::set<std::string>& resources) const;
  /// Whether a controller claims the hand, the arm, or no joint command.
  bool isValidController(const hardware_interface::ControllerInfo& controller) const;
  /// Both fingers' efforts.
  bool isClaimingGripperController(const hardware_interface::ControllerInfo& controller) const;
  /// All seven joints of the arm by the first joint interface that it claims.
  bool isClaimingArmController(const hardware_interface::ControllerInfo& controller) const;
  /// Quantity that a hardware interface commands; none if it commands no joints.
  static boost::optional<ControlMethod> determineControlMethod(
      const std::string& hardware_interface);

 private:
  std::set<std::string> joint_names_;
  std::string arm_id_;
};

}  // namespace franka_gazebo
