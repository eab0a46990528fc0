// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// The rules of the interface that commands a robot (protocol 5.1) (decision 15).
enum class InterfaceRules {
  /// A robot: collisions, violated limits and lost commands end a motion; setters are refused in
  /// Move; the Cartesian thresholds are for O_F_ext_hat_K.
  kFci,
  /// The ROS simulation: contacts and collisions are only shown; setters are accepted in Move; the
  /// Cartesian thresholds are for K_F_ext_hat_K, as in the manual of the ROS simulation.
  kRosControl,
  /// The ROS simulation with the reflexes of a robot.
  kRosControlWithReflexes,
};

/// Whether collisions and violated limits stop the robot.
constexpr bool hasReflexes(InterfaceRules rules) noexcept {
  return rules != InterfaceRules::kRosControl;
}
/// Whether setters are accepted in Move.
constexpr bool acceptsSettersInMotion(InterfaceRules rules) noexcept {
  return rules != InterfaceRules::kFci;
}
/// Whether Cartesian thresholds are for O_F_ext_hat_K; otherwise they are for K_F_ext_hat_K.
constexpr bool checksWrenchInBase(InterfaceRules rules) noexcept {
  return rules == InterfaceRules::kFci;
}

}  // namespace franka_sim
