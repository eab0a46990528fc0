// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

namespace franka_sim {

struct RobotDescription;

/// Joint properties that URDFs do not contain (decision 1), joints 1 to 7.
struct JointPhysics {
  std::array<double, 7> rotor_inertia{{0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}};  ///< [kg m^2]
  std::array<double, 7> coulomb_friction{};                                  ///< [Nm]
  std::array<double, 7> damping{};                                           ///< [Nm s/rad]
  struct Stops {
    std::array<double, 7> lower, upper;  ///< [rad]
  };
  std::optional<Stops> stops;  ///< (decision 8); without them the URDF's limits are the stops
};

/// Reads franka_description's physics.yaml.
/// @param robot_type its section: "panda" or "fr3"
/// @param friction_set "none", "fr3"; see the file
/// @throws std::runtime_error with the file and the error
JointPhysics readJointPhysics(const std::string& file, const std::string& robot_type,
                              const std::string& friction_set);

/// Sets the properties of the joints <arm_id>_joint1 to 7.
void applyJointPhysics(const JointPhysics& physics, const std::string& arm_id,
                       RobotDescription& description);

}  // namespace franka_sim
