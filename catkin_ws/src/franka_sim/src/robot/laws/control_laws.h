// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/fixed_pointer.h>

#include <array>

#include "robot/configuration.h"
#include "robot/estimator/estimate.h"
#include "robot/transforms.h"

namespace franka_sim {

/// Changes from one control law to the next without a torque step: the difference of the laws at
/// the switch is added and fades at the torque rate that the robot allows (protocol 5.5). Called by
/// one thread. Real-time safe.
class TorqueBlend {
 public:
  /// The law changes before the next `apply`.
  void lawChanges() noexcept { changing_ = true; }
  /// The same for a law that starts from zero: its torque acts at once.
  void lawStartsFromZero() noexcept {
    changing_ = false;
    offset_ = last_;
  }
  /// No torque acts (brakes closed): nothing to blend from.
  void restart() noexcept;

  /// @param tau of the present law [Nm] @returns the torque to apply [Nm]
  std::array<double, 7> apply(const std::array<double, 7>& tau) noexcept;

 private:
  bool changing_{false};
  std::array<double, 7> offset_{}, last_{};
};

/// Each torque saturated to the motor's range; values that are not finite become zero.
/// Real-time safe. @param limit [Nm]
std::array<double, 7> saturate(const std::array<double, 7>& tau,
                               const std::array<double, 7>& limit) noexcept;

/// The torque of external control: the last commanded one, saturated to the motors' range and held
/// while commands are missing (protocol 5.3). Called by one thread. Real-time safe.
class TorqueCommand {
 public:
  explicit TorqueCommand(const std::array<double, 7>& limit) noexcept : limit_(limit) {}

  /// @param tau without gravity [Nm]; ignored as a whole when any value is not finite
  /// @returns whether it was accepted.
  bool receive(const std::array<double, 7>& tau) noexcept;
  /// Whether `tau` is not finite, or a step to it exceeds the rate of 1000 Nm/s from both the last
  /// commanded and the last saturated torque; tolerance 0.01 Nm/s (decision 14).
  bool jumps(const std::array<double, 7>& tau) const noexcept;
  void clear() noexcept {
    tau_.fill(0.0);
    commanded_.fill(0.0);
  }
  const std::array<double, 7>& value() const noexcept { return tau_; }

 private:
  std::array<double, 7> limit_;
  std::array<double, 7> tau_{}, commanded_{};  // saturated, and as commanded
};

/// Damping of both impedance laws, times sqrt(stiffness * inertia): 0.7 of critical
/// (decisions 10, 11).
constexpr double kDampingFactor = 1.4;

/// Joint impedance law (decision 10): a spring K to the desired position, a damper D_i =
/// kDampingFactor sqrt(K_i (M_ii + B_i)) to the desired velocity, and the Coriolis torques. A joint
/// without stiffness has no damping either. Called by one thread. Real-time safe.
class JointImpedance {
 public:
  /// @param stiffness K [Nm/rad] @param rotor_inertia B [kg m^2]
  JointImpedance(const std::array<double, 7>& stiffness,
                 const std::array<double, 7>& rotor_inertia) noexcept
      : stiffness_(stiffness), rotor_inertia_(rotor_inertia) {}

  /// @param mass M(q), 7x7 column-major, without B [kg m^2] @param coriolis C(q, dq) dq [Nm]
  /// @returns torques without gravity [Nm]
  std::array<double, 7> torque(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                               const std::array<double, 7>& q, const std::array<double, 7>& dq,
                               const std::array<double, 49>& mass,
                               const std::array<double, 7>& coriolis) const noexcept;

 private:
  std::array<double, 7> stiffness_;
  std::array<double, 7> rotor_inertia_;
};

/// Input of the Cartesian impedance law in one tick.
struct CartesianImpedanceInput {
  Transform O_T_EE_d, O_T_EE;           ///< desired and measured, 4x4 column-major
  Transform EE_T_K;                     ///< of the stiffness frame
  std::array<double, 6> O_dP_EE_d;      ///< desired twist of EE in O [m/s, rad/s]
  std::array<double, 42> O_J_EE;        ///< zero Jacobian of EE, 6x7 column-major
  std::array<double, 49> mass;          ///< without rotors, 7x7 column-major [kg m^2]
  std::array<double, 7> q_d, q, dq;     ///< [rad], [rad/s]; q_d is the null space's target
  std::array<double, 7> coriolis;       ///< C(q, dq) dq [Nm]
  std::array<double, 6> K;              ///< stiffness [N/m, Nm/rad], 0 or more
  double nullspace_stiffness{10.0};     ///< [Nm/rad], chosen here (decision 11)
  std::array<double, 7> rotor_inertia;  ///< B [kg m^2]
};

/// The unit's Cartesian impedance law (decision 11): springs and dampers between the desired and
/// the measured stiffness frame, along and about the axes of the measured one; a soft, critically
/// damped spring holds the joints' null space; Coriolis torques are added.
/// D_i = kDampingFactor sqrt(K_i / (J (M + B)^-1 J^T)_ii). The rotation error is a rotation vector.
/// Real-time safe. @returns torques without gravity [Nm]
std::array<double, 7> cartesianImpedance(const CartesianImpedanceInput& input) noexcept;

/// How the torque of one tick continues the torque of the previous tick.
enum class LawSwitch {
  kNone,
  kBlend,     ///< the law changes, but the torque has no step
  kFromZero,  ///< the next law starts at zero: its torque acts at once
};

/// The impedance of a guided arm along the axes that are not free.
struct GuidingTask {
  std::array<bool, 6> free{{true, true, true, true, true, true}};  ///< x, y, z, R, P, Y of K
  bool elbow_free{true};
  std::array<double, 16> O_T_EE{};  ///< the pose in which guiding began
  std::array<double, 7> q{};
};

/// The task of the control laws in a tick.
struct ControlTask {
  franka_core::RobotMode mode{franka_core::RobotMode::kIdle};
  franka_core::ControllerMode controller{franka_core::ControllerMode::kOther};  ///< in Move
  std::array<double, 7> tau{};  ///< torques of an external controller [Nm]
  GuidingTask guiding;
  LawSwitch law_switch{LawSwitch::kNone};
};

/// From command to torque: external torque, joint impedance, Cartesian impedance, hold, guiding;
/// saturation, gravity compensation.
///
///     tau_motor = saturate(blend(saturate(law)) + braking) + saturate(gravity)
///
/// braking: (M + B) ddq_d of an arm that brakes outside of a motion. Gravity includes the
/// configured load. Friction is not compensated: the published values were identified behind the
/// robot's own compensation, so they are what it leaves (decision 1). Called by one thread.
/// Real-time safe.
class ControlLaws {
 public:
  /// @param configuration outlives the laws.
  explicit ControlLaws(const Configuration& configuration) noexcept
      : configuration_(&configuration) {}

  /// The motor torques of the next tick [Nm]. @param estimate of the measured state
  const std::array<double, 7>& torques(const ControlTask& task,
                                       const franka_core::RobotState& state,
                                       const Estimate& estimate) noexcept;
  /// Zero torques: the brakes are closed, or there has been no measurement yet.
  const std::array<double, 7>& rest() noexcept;
  void restart() noexcept { blend_.restart(); }

  /// Torques of the last tick [Nm]: of the law, saturated, without gravity; and of the motors.
  const std::array<double, 7>& law() const noexcept { return law_; }
  const std::array<double, 7>& motorTorques() const noexcept { return motor_torques_; }

 private:
  std::array<double, 7> law(const ControlTask& task, const franka_core::RobotState& state,
                            const Estimate& estimate) const noexcept;

  FixedPointer<const Configuration> configuration_;
  TorqueBlend blend_;
  std::array<double, 7> law_{};
  std::array<double, 7> motor_torques_{};
};

}  // namespace franka_sim
