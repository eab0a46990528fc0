// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/sensor_physics.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

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
constexpr bool checksWrenchInBase(InterfaceRules rules) noexcept {
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

/// Protocol versions that a robot speaks.
struct ProtocolRange {
  std::uint16_t oldest;  ///< included
  std::uint16_t newest;  ///< included
};

/// All versions of a robot's generation (decision 25). @param robot "fr3"; any other value is a
/// Panda
inline ProtocolRange protocolsOf(const std::string& robot) noexcept {
  return robot == "fr3" ? ProtocolRange{6, 10} : ProtocolRange{3, 5};
}

/// The cause of a collision reflex: the joint or axis that was farthest beyond its upper threshold
/// in the tick of the reflex.
struct Collision {
  bool happened{false};   ///< whether there was one
  std::size_t index{0};   ///< of the joint, or of x, y, z, R, P, Y
  double value{0.0};      ///< external torque [Nm] or force [N], not filtered
  double threshold{0.0};  ///< the upper one in effect [Nm, N]
};

/// Which magnitudes are above their thresholds: 1 or 0, as the flags of RobotState. Real-time safe.
template <std::size_t N>
std::array<double, N> above(const std::array<double, N>& values,
                            const std::array<double, N>& thresholds) noexcept;

/// "joint 4: external torque 23.4 Nm, upper threshold 20 Nm". Not real-time safe.
std::string describeJointCollision(const Collision& collision);
/// "along z of O: external force -25.1 N, upper threshold 20 N", or about it, or of K.
/// Not real-time safe.
std::string describeCartesianCollision(const Collision& collision, InterfaceRules rules);

constexpr int kHandLink = 8;  ///< its frame: the flange turned by -45 degrees about z

/// Two parts of an arm that are close to each other: links 0 to 7, or kHandLink.
struct LinkPair {
  int first{0}, second{0};  ///< the two parts
  double distance{0.0};     ///< between their surfaces, negative inside each other [m]
};

}  // namespace franka_sim
