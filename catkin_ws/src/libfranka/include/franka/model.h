// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot.h>
#include <franka/robot_state.h>

#include <array>
#include <memory>
#include <string>

/// @file
/// The frames of the arm's kinematics, and franka::Model.

namespace franka {

/// A frame on the arm, from the base to the tip.
enum class Frame {
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

/// Increments to the next frame and returns the previous value, for loops over all frames: `for
/// (Frame f = Frame::kJoint1; f <= Frame::kStiffness; f++)`. The value after kStiffness is not a
/// valid frame.
Frame operator++(Frame& frame, int /* postfix */) noexcept;

/// Kinematics and dynamics of the arm: of the robot, from Robot::loadModel, or from a URDF without
/// any robot.
///
/// Real-time safe. Thread-safe. Only creating a model allocates. Poses and zero Jacobians are
/// expressed in the base frame O, body Jacobians in the frame's own axes. Transforms are 4x4,
/// Jacobians 6x7 (linear rows first), the mass matrix 7x7, inertias 3x3, all column-major.
/// `I_total`, `m_total` and `F_x_Ctotal` are of end effector and load together: inertia about their
/// center of mass in the axes of F [kg m^2], mass [kg], center of mass in F [m].
class Model {
 public:
  /// @name Without a robot (not in the vendor's library)
  /// @{

  /// The arm of a URDF text with inertials. @param arm_id prefix of its links; empty: the only arm
  /// in the text. @throws ModelException with a sentence if there is none.
  static Model fromUrdf(const std::string& urdf, const std::string& arm_id = "");
  /// The same from a file. @throws ModelException also if it cannot be read.
  static Model fromUrdfFile(const std::string& path, const std::string& arm_id = "");
  /// @}

  /// The arm of a description (URDF) from a robot: like fromUrdf, with the signature of libfranka
  /// 0.14 and later.
  explicit Model(const std::string& urdf);
  Model(Model&& model) noexcept;
  Model& operator=(Model&& model) noexcept;
  ~Model() noexcept;

  /// Pose of a frame in O. @throws std::invalid_argument for an invalid frame.
  std::array<double, 16> pose(Frame frame, const RobotState& robot_state) const;
  /// @copydoc pose(Frame, const RobotState&) const
  std::array<double, 16> pose(Frame frame, const std::array<double, 7>& q,
                              const std::array<double, 16>& F_T_EE,
                              const std::array<double, 16>& EE_T_K) const;

  /// Jacobian of a frame in its own axes. @throws as pose.
  std::array<double, 42> bodyJacobian(Frame frame, const RobotState& robot_state) const;
  /// @copydoc bodyJacobian(Frame, const RobotState&) const
  std::array<double, 42> bodyJacobian(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const;

  /// Jacobian of a frame in O. @throws as pose.
  std::array<double, 42> zeroJacobian(Frame frame, const RobotState& robot_state) const;
  /// @copydoc zeroJacobian(Frame, const RobotState&) const
  std::array<double, 42> zeroJacobian(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const;

  /// Mass matrix [kg m^2].
  std::array<double, 49> mass(const RobotState& robot_state) const noexcept;
  std::array<double, 49> mass(const std::array<double, 7>& q, const std::array<double, 9>& I_total,
                              double m_total,
                              const std::array<double, 3>& F_x_Ctotal) const noexcept;

  /// Coriolis torques C(q, dq) dq [Nm].
  std::array<double, 7> coriolis(const RobotState& robot_state) const noexcept;
  std::array<double, 7> coriolis(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                 const std::array<double, 9>& I_total, double m_total,
                                 const std::array<double, 3>& F_x_Ctotal) const noexcept;
  /// The same with the signature of libfranka 0.14 and later; gravity has no effect.
  std::array<double, 7> coriolis(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                 const std::array<double, 9>& I_total, double m_total,
                                 const std::array<double, 3>& F_x_Ctotal,
                                 const std::array<double, 3>& gravity_earth) const noexcept;

  /// Gravity torques: those that hold the arm [Nm]. @param gravity_earth in O [m/s^2]
  std::array<double, 7> gravity(const std::array<double, 7>& q, double m_total,
                                const std::array<double, 3>& F_x_Ctotal,
                                const std::array<double, 3>& gravity_earth = {
                                    {0.0, 0.0, -9.81}}) const noexcept;
  std::array<double, 7> gravity(const RobotState& robot_state,
                                const std::array<double, 3>& gravity_earth) const noexcept;
  /// With the gravity that the robot measures, O_ddP_O.
  std::array<double, 7> gravity(const RobotState& robot_state) const noexcept;

  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  /// Source of the results. Internal to the library.
  class Source;
  explicit Model(std::unique_ptr<Source> source);

 private:
  std::unique_ptr<Source> source_;
};

}  // namespace franka
