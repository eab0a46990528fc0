// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace franka_core {

/// The ten frames of the arm, in the order of franka::Frame.
enum class ArmFrame {
  kJoint1,
  kJoint2,
  kJoint3,
  kJoint4,
  kJoint5,
  kJoint6,
  kJoint7,
  kFlange,
  kEndEffector,
  kStiffness
};

/// The 4x4 identity, column-major.
constexpr std::array<double, 16> kIdentityTransform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// The body at the flange: end effector and load taken together.
struct Payload {
  double mass{0.0};             ///< [kg]
  std::array<double, 3> com{};  ///< F_x_C, center of mass in flange frame F [m]
  std::array<double, 9>
      inertia{};  ///< about the center of mass, axes of F, 3x3 column-major [kg m^2]
};

/// Mass, Coriolis, gravity, pose and Jacobian, computed together.
struct ArmDynamics {
  std::array<double, 49> mass;     ///< 7x7 column-major [kg m^2]
  std::array<double, 7> coriolis;  ///< C(q, dq) dq [Nm]
  std::array<double, 7> gravity;   ///< torques that hold the arm [Nm]
  std::array<double, 16> pose;     ///< of the requested frame in O, 4x4 column-major
  std::array<double, 42>
      zero_jacobian;  ///< of the requested frame in O, 6x7 column-major, linear rows first
};

/// Kinematics and dynamics of the seven-joint chain with a payload at the flange.
///
/// Parameters (link inertias, joint origins) come from a URDF; rotor inertia and friction are not
/// included. Const functions throw nothing. Real-time safe. Thread-safe. All poses and Jacobians
/// are expressed in the base frame O (link0). Gravity vectors point down ([0, 0, -9.81] for a robot
/// on a table) and are expressed in O [m/s^2].
class ArmModel {
 public:
  /// Fixed transform from parent joint to joint (column-major), and the link's inertia in its own
  /// frame.
  struct Link {
    std::array<double, 16> origin{kIdentityTransform};  ///< pose in the link before, column-major
    double mass{0.0};                                   ///< [kg]
    std::array<double, 3> com{};                        ///< in the link [m]
    std::array<double, 9> inertia{};                    ///< about com, link axes, column-major
  };

  /// @param links links 1 to 7, each with the transform of its joint; joint axis is +z of the link
  /// frame.
  /// @param flange transform from link 7 to flange F, column-major.
  ArmModel(const std::array<Link, 7>& links, const std::array<double, 16>& flange);

  /// Reads the chain `<prefix>link0` ... `<prefix>link8` from a URDF text. Bodies rigidly fixed to
  /// one of the links 1 to 7 count as part of it; those below link8 do not (see
  /// endEffectorFromUrdf).
  /// @param arm_id prefix without the underscore; empty: the only chain in the text.
  /// @throws std::invalid_argument with a sentence that names the error.
  static ArmModel fromUrdf(const std::string& urdf, const std::string& arm_id = "");

  /// Pose of a frame in O. F_T_EE and EE_T_K matter only for kEndEffector and kStiffness.
  std::array<double, 16> pose(
      ArmFrame frame, const std::array<double, 7>& q,
      const std::array<double, 16>& F_T_EE = kIdentityTransform,
      const std::array<double, 16>& EE_T_K = kIdentityTransform) const noexcept;
  /// Jacobian of the frame's origin in O, 6x7 column-major; columns of later joints are zero.
  std::array<double, 42> zeroJacobian(
      ArmFrame frame, const std::array<double, 7>& q,
      const std::array<double, 16>& F_T_EE = kIdentityTransform,
      const std::array<double, 16>& EE_T_K = kIdentityTransform) const noexcept;
  /// The same Jacobian expressed in the frame's own axes.
  std::array<double, 42> bodyJacobian(
      ArmFrame frame, const std::array<double, 7>& q,
      const std::array<double, 16>& F_T_EE = kIdentityTransform,
      const std::array<double, 16>& EE_T_K = kIdentityTransform) const noexcept;
  /// Joint-space mass matrix by the composite rigid body algorithm, 7x7 column-major [kg m^2].
  std::array<double, 49> mass(const std::array<double, 7>& q,
                              const Payload& payload) const noexcept;
  /// Coriolis and centrifugal torques C(q, dq) dq by the recursive Newton-Euler algorithm [Nm].
  std::array<double, 7> coriolis(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                 const Payload& payload) const noexcept;
  /// Torques that hold the arm against gravity [Nm].
  std::array<double, 7> gravity(const std::array<double, 7>& q, const Payload& payload,
                                const std::array<double, 3>& gravity_earth = {
                                    {0, 0, -9.81}}) const noexcept;
  /// Inverse dynamics by the recursive Newton-Euler algorithm: M(q) ddq + C(q, dq) dq + g(q) [Nm].
  std::array<double, 7> inverseDynamics(const std::array<double, 7>& q,
                                        const std::array<double, 7>& dq,
                                        const std::array<double, 7>& ddq, const Payload& payload,
                                        const std::array<double, 3>& gravity_earth = {
                                            {0, 0, -9.81}}) const noexcept;
  /// Mass, Coriolis, gravity, pose and zero Jacobian of one frame: the algorithms above with one
  /// common loop over the links.
  void computeDynamics(ArmFrame frame, const std::array<double, 7>& q,
                       const std::array<double, 7>& dq, const std::array<double, 16>& F_T_EE,
                       const std::array<double, 16>& EE_T_K, const Payload& payload,
                       const std::array<double, 3>& gravity_earth,
                       ArmDynamics& result) const noexcept;

  const std::array<Link, 7>& links() const noexcept { return links_; }       ///< from joint 1 on
  const std::array<double, 16>& flange() const noexcept { return flange_; }  ///< pose in link 7

 private:
  std::array<Link, 7> links_;
  std::array<double, 16> flange_;
};

/// End effector and load as one body about their common center of mass (parallel-axis theorem).
/// A part of zero mass contributes nothing, its inertia included (protocol 8.4).
Payload combine(const Payload& end_effector, const Payload& load) noexcept;

/// All bodies below `<prefix>link8` (hand and fingers, movable joints at position 0: fingers
/// closed) as one body in the flange frame (decision 7). Zero payload if there are none.
/// @param arm_id as for ArmModel::fromUrdf.
/// @throws std::invalid_argument with a sentence if the URDF cannot be read, the chain is missing,
/// or the hand or a moving link of it has no inertial.
Payload endEffectorFromUrdf(const std::string& urdf, const std::string& arm_id = "");

/// F_T_NE as described, column-major: the frame `<prefix>hand_tcp`, or the point between the
/// fingertips of a hand without this frame (decision 7). It follows whatever is mounted between
/// flange and hand; movable joints are at position 0. Empty if the URDF describes neither.
/// @param arm_id as for ArmModel::fromUrdf.
/// @throws std::invalid_argument with a sentence if the URDF cannot be read, the chain is missing,
/// or an origin is not finite.
std::optional<std::array<double, 16>> nominalEndEffectorFromUrdf(const std::string& urdf,
                                                                 const std::string& arm_id = "");

}  // namespace franka_core
