// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/interface_rules.h>
#include <franka_sim/robot/safety/collision_thresholds.h>
#include <franka_sim/robot/sensor_physics.h>

#include <array>
#include <cmath>
#include <string>

namespace franka_sim {

/// From the flange to the hand's nominal end effector: turned by -45 deg about z, 0.1034 m along z
/// (protocol 8.3).
constexpr std::array<double, 16> kHandF_T_NE{
    M_SQRT1_2, -M_SQRT1_2, 0, 0, M_SQRT1_2, M_SQRT1_2, 0, 0, 0, 0, 1, 0, 0, 0, 0.1034, 1};

/// Stiffness of the idle hold, and initial value of joint impedance control [Nm/rad] (decision 11).
constexpr std::array<double, 7> kJointStiffness{3000, 3000, 3000, 2500, 2500, 2000, 2000};

/// The initial configuration of a control unit. Default thresholds are those of the original
/// franka_gazebo; the source of each other default is given with it.
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

/// Whether the arm accepts this payload: finite, mass not negative, inertia symmetric without a
/// negative principal moment, within the limits of franka_core/limits.h. A mass without inertia (a
/// point) is accepted. Real-time safe.
bool isPayload(const franka_core::Payload& payload) noexcept;

/// Why it is not accepted: a sentence with value, limit and unit; empty if it is.
std::string payloadFault(const franka_core::Payload& payload);

/// Largest distance of a frame on the arm from its parent frame [m] (chosen here).
constexpr double kMaxFrameDistance = 10.0;

/// Whether it is a rigid transform to a frame that can be on the arm. Real-time safe.
bool isFrame(const std::array<double, 16>& transform) noexcept;

/// Why it is not one, as the end of a sentence that names it; empty if it is. Not real-time safe.
std::string frameFault(const std::array<double, 16>& transform);

/// Whether all thresholds are finite and not negative. Real-time safe.
bool areThresholds(const CollisionThresholds& thresholds) noexcept;

/// Whether the robot accepts these stiffnesses: 0 to 14250 Nm/rad (protocol 5.7). Real-time safe.
bool isJointStiffness(const std::array<double, 7>& K) noexcept;

/// Likewise: 10 to 3000 N/m, 1 to 300 Nm/rad. Real-time safe.
bool isCartesianStiffness(const std::array<double, 6>& K) noexcept;

/// @throws std::invalid_argument with a sentence that names the first invalid parameter.
void checkParameters(const ControlUnitParameters& parameters);

}  // namespace franka_sim
