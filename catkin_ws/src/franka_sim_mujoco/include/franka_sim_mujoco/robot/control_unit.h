// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/robot_state.h>
#include <franka_sim_mujoco/robot/command_window.h>
#include <franka_sim_mujoco/robot/contact_monitor.h>
#include <franka_sim_mujoco/robot/control_unit_parameters.h>
#include <franka_sim_mujoco/robot/external_torque.h>
#include <franka_sim_mujoco/robot/external_wrench.h>
#include <franka_sim_mujoco/robot/joint_impedance.h>
#include <franka_sim_mujoco/robot/low_pass.h>
#include <franka_sim_mujoco/robot/mode_machine.h>
#include <franka_sim_mujoco/robot/plant.h>
#include <franka_sim_mujoco/robot/torque_command.h>

#include <array>

namespace franka_sim_mujoco {

/// The answer to a request; the numbers are the unit's own, each face maps them to its protocol.
enum class RequestStatus {
  kSuccess,
  kNotPossible,      ///< not in the present mode
  kInvalidArgument,  ///< outside its range, not finite, or not a transform
};

/// What Franka's control cabinet does, once a millisecond.
///
/// A tick has two halves: `observe` turns a measurement into state k; `actuate` takes the command
/// that answers state k (or none) and gives the torques that act until k+1. Requests (start of a
/// motion, setters, stops) are made between these calls. A request shows in `state()` at once where
/// it sets a mode or a configuration; what is computed from them follows with the next `observe`.
///
/// One thread owns a unit; nothing in it locks, allocates, logs, throws (but for the constructor)
/// or asks a clock, so the same inputs give the same states bit for bit. Frames and units:
/// franka_core::RobotState.
class ControlUnit {
 public:
  /// Starts in Idle and holds the pose of the first measurement.
  /// @throws std::invalid_argument with a sentence that names the parameter which makes no sense.
  explicit ControlUnit(const ControlUnitParameters& parameters);

  /// First half of a tick. The reference stays valid until the next call.
  /// The first sample after the start or a restart has no tick of motor torques behind it: tau_J
  /// then shows gravity, as the sensor of a resting arm does, and no external torque is told. A
  /// sample that is not finite is replaced by the last good pose at rest.
  const franka_core::RobotState& observe(const ArmMeasurement& measurement) noexcept;

  /// Second half: the motor torques for the coming tick [Nm]: command, saturated, plus gravity of
  /// the configured load and friction compensation.
  /// @param command nullptr when none arrived; the last torque is held. A command with a torque
  /// that is not finite counts as none. `torque_command_finished` ends the motion: the arm is held
  /// from this tick on.
  const std::array<double, 7>& actuate(const franka_core::RobotCommand* command) noexcept;

  /// Whether the joints are locked (UserStopped, Other). To be asked after `actuate`.
  bool brakesClosed() const noexcept { return modes_.brakesClosed(); }

  const franka_core::RobotState& state() const noexcept { return state_; }

  /// Idle -> Move with external torque control (no motion generator). q_d stays where the arm
  /// stands now.
  RequestStatus startTorqueControl() noexcept;
  /// Move -> Idle; holds where the arm stands.
  RequestStatus stopMotion() noexcept;
  /// The external activation device: pressed stops any motion and closes the brakes, released gives
  /// Idle.
  void setUserStop(bool pressed) noexcept;
  /// Clears errors and latched collisions; refused while the user stop is pressed.
  RequestStatus automaticErrorRecovery() noexcept;

  /// NE_T_EE, EE_T_K: refused when not homogeneous (see isTransform).
  RequestStatus setEE(const std::array<double, 16>& NE_T_EE) noexcept;
  RequestStatus setK(const std::array<double, 16>& EE_T_K) noexcept;
  /// Refused when not finite, of negative mass, or with an inertia no body has (not symmetric, a
  /// negative principal moment).
  RequestStatus setLoad(const franka_core::Payload& load) noexcept;
  /// Refused when not finite or negative. A lower threshold at or above the upper one means: no
  /// contacts.
  RequestStatus setCollisionBehavior(const CollisionThresholds& acceleration,
                                     const CollisionThresholds& nominal) noexcept;

  /// After the arm was put elsewhere (reset, teleport): forgets velocities, filters, commands and
  /// collisions, and holds the new pose. The mode and the configuration stay.
  void restart() noexcept;

  /// The configuration as the setters left it.
  const ControlUnitParameters& parameters() const noexcept { return parameters_; }

 private:
  bool settersAllowed() const noexcept;
  bool handle(ModeEvent event) noexcept;
  void holdHere() noexcept;
  void showModes() noexcept;
  void showConfiguration() noexcept;
  void observeTorques(const ArmMeasurement& measurement, bool measured) noexcept;
  void observeContacts(const std::array<double, 7>& tau_ext) noexcept;
  void observeDesired() noexcept;
  bool takeCommand(const franka_core::RobotCommand* command) noexcept;

  ControlUnitParameters parameters_;
  franka_core::Payload total_;  // end effector and load
  franka_core::RobotState state_;
  ModeMachine modes_;

  bool started_{false};                  // a measurement has been seen since the start or restart
  bool continuous_{false};               // the last sample was a good one of the same motion
  bool desired_stale_{true};             // q_d or the frames have changed
  franka_core::ArmDynamics dynamics_{};  // at the last measurement, frame EE
  ExternalTorque external_torque_;
  ExternalWrench external_wrench_;
  LowPass<7> tau_ext_filter_, dtau_J_filter_;
  ContactMonitor<7> joint_contacts_;
  ContactMonitor<6> cartesian_contacts_;
  JointImpedance hold_;
  TorqueCommand torque_command_;
  CommandWindow command_window_;
  std::array<double, 7> motor_torque_{};
};

}  // namespace franka_sim_mujoco
