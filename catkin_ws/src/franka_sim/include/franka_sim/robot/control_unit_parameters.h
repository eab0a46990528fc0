// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/sensor_physics.h>

#include <array>
#include <cmath>

namespace franka_sim {

/// Thresholds of contact (lower) and collision (upper), [Nm] and [N, N, N, Nm, Nm, Nm].
struct CollisionThresholds {
  std::array<double, 7> lower_torque, upper_torque;  ///< seven joints
  std::array<double, 6> lower_force, upper_force;    ///< x, y, z
};

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
constexpr bool judgesWrenchInBase(InterfaceRules rules) noexcept {
  return rules == InterfaceRules::kFci;
}

/// From the flange to the hand's nominal end effector: turned by -45 deg about z, 0.1034 m along z
/// (protocol 8.3).
constexpr std::array<double, 16> kHandF_T_NE{
    M_SQRT1_2, -M_SQRT1_2, 0, 0, M_SQRT1_2, M_SQRT1_2, 0, 0, 0, 0, 1, 0, 0, 0, 0.1034, 1};

/// Stiffness of the idle hold, and initial value of joint impedance control [Nm/rad] (decision 11).
constexpr std::array<double, 7> kJointStiffness{3000, 3000, 3000, 2500, 2500, 2000, 2000};

/// The initial configuration of a control unit. Default thresholds are those of the original
/// franka_gazebo; the source of each other default stands beside it.
struct ControlUnitParameters {
  franka_core::ArmModel model;                                     ///< of the arm, for estimates
  std::array<double, 7> max_torque{{87, 87, 87, 87, 12, 12, 12}};  ///< [Nm] (protocol 5.5)
  std::array<double, 7> rotor_inertia{
      {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}};                         ///< B [kg m^2] (decision 1)
  SensorPhysics sensors{};                                          ///< noise and offsets
  std::array<double, 3> gravity{{0, 0, -9.81}};                     ///< O_ddP_O, in O [m/s^2]
  std::array<double, 16> F_T_NE{franka_core::kIdentityTransform};   ///< column-major
  std::array<double, 16> NE_T_EE{franka_core::kIdentityTransform};  ///< column-major
  std::array<double, 16> EE_T_K{franka_core::kIdentityTransform};   ///< column-major
  franka_core::Payload end_effector{};                              ///< m_ee, F_x_Cee, I_ee
  franka_core::Payload load{};                                      ///< m_load, F_x_Cload, I_load
  /// Thresholds of motions without acceleration.
  CollisionThresholds nominal{{{20, 20, 18, 18, 16, 14, 12}},
                              {{20, 20, 18, 18, 16, 14, 12}},
                              {{20, 20, 20, 25, 25, 25}},
                              {{20, 20, 20, 25, 25, 25}}};
  CollisionThresholds acceleration{nominal};               ///< while a motion accelerates
  std::array<double, 7> joint_stiffness{kJointStiffness};  ///< [Nm/rad]
  /// Initial value of Cartesian impedance control [N/m, Nm/rad] (decision 11).
  std::array<double, 6> cartesian_stiffness{{3000, 3000, 3000, 300, 300, 300}};
  bool has_hand{true};                                ///< for the avoidance of self-collisions
  unsigned protocol_version{5};                       ///< selects the limits (decisions 8, 25)
  InterfaceRules rules{InterfaceRules::kRosControl};  ///< who commands it
};

}  // namespace franka_sim
