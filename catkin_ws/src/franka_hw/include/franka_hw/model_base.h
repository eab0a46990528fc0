// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/model.h>
#include <franka/robot_state.h>

#include <array>

namespace franka_hw {

/// Interface of kinematics and dynamics of an arm.
///
/// Layouts: transforms 4x4, Jacobians 6x7 (linear rows first), the mass matrix 7x7 and inertias
/// 3x3, all column-major. Units [m] [rad] [s] [kg] [Nm]. Poses and zero Jacobians are expressed in
/// the base frame O, body Jacobians in the axes of their frame. F_x_Ctotal is the center of mass of
/// end effector and load together in the flange frame F, total_inertia their inertia about that
/// point in the axes of F.
class ModelBase {
 public:
  virtual ~ModelBase() noexcept = default;

  /// Pose of a frame in O. F_T_EE and EE_T_K are used for kEndEffector and kStiffness only.
  virtual std::array<double, 16> pose(franka::Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const = 0;
  /// Jacobian of a frame, expressed in the axes of that frame.
  virtual std::array<double, 42> bodyJacobian(franka::Frame frame, const std::array<double, 7>& q,
                                              const std::array<double, 16>& F_T_EE,
                                              const std::array<double, 16>& EE_T_K) const = 0;
  /// Jacobian of a frame, expressed in O.
  virtual std::array<double, 42> zeroJacobian(franka::Frame frame, const std::array<double, 7>& q,
                                              const std::array<double, 16>& F_T_EE,
                                              const std::array<double, 16>& EE_T_K) const = 0;
  /// Joint-space mass matrix [kg m^2].
  virtual std::array<double, 49> mass(const std::array<double, 7>& q,
                                      const std::array<double, 9>& total_inertia, double total_mass,
                                      const std::array<double, 3>& F_x_Ctotal) const = 0;
  /// Coriolis and centrifugal torques C(q, dq) dq [Nm].
  virtual std::array<double, 7> coriolis(const std::array<double, 7>& q,
                                         const std::array<double, 7>& dq,
                                         const std::array<double, 9>& total_inertia,
                                         double total_mass,
                                         const std::array<double, 3>& F_x_Ctotal) const = 0;
  /// Torques that hold the arm against gravity [Nm]. @param gravity_earth in O [m/s^2]
  virtual std::array<double, 7> gravity(const std::array<double, 7>& q, double total_mass,
                                        const std::array<double, 3>& F_x_Ctotal,
                                        const std::array<double, 3>& gravity_earth) const = 0;

  /// @name The same, with the arguments from a robot state
  /// @{
  std::array<double, 16> pose(franka::Frame frame, const franka::RobotState& robot_state) const;
  std::array<double, 42> bodyJacobian(franka::Frame frame,
                                      const franka::RobotState& robot_state) const;
  std::array<double, 42> zeroJacobian(franka::Frame frame,
                                      const franka::RobotState& robot_state) const;
  std::array<double, 49> mass(const franka::RobotState& robot_state) const;
  std::array<double, 7> coriolis(const franka::RobotState& robot_state) const;
  /// Gravity from the base's acceleration sensor (O_ddP_O); without one, gravity points straight
  /// down.
  std::array<double, 7> gravity(const franka::RobotState& robot_state) const;
  std::array<double, 7> gravity(const franka::RobotState& robot_state,
                                const std::array<double, 3>& gravity_earth) const;
  /// @}

  /// Gravity torques of a robot that stands upright, gravity (0, 0, -9.81) m/s^2 [Nm].
  std::array<double, 7> gravity(const std::array<double, 7>& q, double total_mass,
                                const std::array<double, 3>& F_x_Ctotal) const;
};

}  // namespace franka_hw
