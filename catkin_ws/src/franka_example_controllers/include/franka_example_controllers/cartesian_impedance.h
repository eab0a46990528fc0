// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_example_controllers/torque_rate.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace franka_example_controllers {

/// Stiffness parameters.
struct Compliance {
  double translational_stiffness{0.0};  ///< [N/m]
  double rotational_stiffness{0.0};     ///< [Nm/rad]
  double nullspace_stiffness{0.0};      ///< [Nm/rad]
};

/// Damping of the inverse for the null space projection. The projection is always bounded, but
/// along a direction with singular value s the share s_d^2 / (s^2 + s_d^2) of the null-space torque
/// acts on the end effector: with the 0.2 of pseudoInverse(), a null-space stiffness of 10 Nm/rad
/// displaced the end effector by 5 cm from its equilibrium.
constexpr double kNullSpaceDamping = 2e-3;

/// Representation of an orientation error as a vector.
enum class RotationError {
  kQuaternion,  ///< vector part of the unit quaternion: for small angles half of the rotation
                ///< vector
  kAxisAngle    ///< rotation vector: axis times angle [rad]
};

/// A Cartesian impedance with a null-space impedance for one seven-joint arm.
///
/// Springs and critical dampers (2 sqrt(K)) pull the end effector to an equilibrium pose, and the
/// elbow to its start configuration in the null space. Stiffness, damping and equilibrium approach
/// their targets by 0.5 % per update, without jumps. The robot compensates gravity.
///
/// Called by one thread at 1 kHz. No function throws. Real-time safe. Frame O, units [m] [rad] [N]
/// [Nm].
class CartesianImpedance {
 public:
  using Vector7 = Eigen::Matrix<double, 7, 1>;  ///< a value per joint

  explicit CartesianImpedance(RotationError rotation_error = RotationError::kQuaternion)
      : rotation_error_(rotation_error) {}

  /// Input of the law in one cycle.
  struct Arm {
    std::array<double, 16> O_T_EE;         ///< 4x4 column-major
    std::array<double, 42> zero_jacobian;  ///< of the end effector, 6x7 column-major
    std::array<double, 7> coriolis;        ///< Coriolis torques [Nm]
    std::array<double, 7> q;               ///< joint positions [rad]
    std::array<double, 7> dq;              ///< joint velocities [rad/s]
    std::array<double, 7> tau_J_d;         ///< torque commanded in the last cycle, without gravity
  };

  /// Starts at a pose and a configuration, which become the equilibrium. Springs and dampers of the
  /// end effector grow from zero; the null-space stiffness applies at once.
  void start(const std::array<double, 16>& O_T_EE, const std::array<double, 7>& q,
             double nullspace_stiffness) noexcept;

  /// Sets the equilibrium pose. @param orientation a unit quaternion
  void setEquilibrium(const Eigen::Vector3d& position,
                      const Eigen::Quaterniond& orientation) noexcept;

  /// Sets the stiffness that the law approaches in the next cycles.
  void setCompliance(const Compliance& compliance) noexcept { compliance_target_ = compliance; }

  /// Torques of this cycle without gravity; each differs from tau_J_d by 1 Nm at most.
  Vector7 update(const Arm& arm) noexcept;

 private:
  /// Spring and damper constants, for the translations (index 0) and the rotations (index 1).
  struct Gains {
    std::array<double, 2> stiffness{};
    std::array<double, 2> damping{};
  };

  Eigen::Matrix<double, 6, 1> poseError(const std::array<double, 16>& O_T_EE) const noexcept;
  void approachTargets() noexcept;

  RotationError rotation_error_;
  Gains gains_;
  double nullspace_stiffness_{0.0};
  Compliance compliance_target_;
  Eigen::Vector3d position_d_{Eigen::Vector3d::Zero()};
  Eigen::Quaterniond orientation_d_{Eigen::Quaterniond::Identity()};
  Eigen::Vector3d position_target_{Eigen::Vector3d::Zero()};
  Eigen::Quaterniond orientation_target_{Eigen::Quaterniond::Identity()};
  Vector7 q_nullspace_{Vector7::Zero()};
};

}  // namespace franka_example_controllers
