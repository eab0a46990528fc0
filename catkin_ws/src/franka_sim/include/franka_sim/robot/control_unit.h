// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/unit_request.h>
#include <franka_sim/robot/unit_status.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace franka_core {
struct MotionLimits;
}

namespace franka_sim {

/// The functions of Franka's control cabinet, once per millisecond.
///
/// A tick has two halves: `observe` computes state k from a measurement; `actuate` takes the
/// command that answers state k (or none) and computes the torques that act until k+1. Requests are
/// made between these calls. `state()` shows modes and settings of a request at once; values
/// computed from them follow with the next `observe`.
///
/// Its parts: StateEstimator, MotionSupervisor, ControlLaws. Called by one thread. Real-time safe.
/// Exception: the constructor. Uses no clock, so the same inputs give bitwise identical states.
/// Frames and units: franka_core::RobotState.
class ControlUnit {
 public:
  /// Starts in Idle and holds the pose of the first measurement.
  /// @throws std::invalid_argument that names the invalid parameter.
  explicit ControlUnit(const ControlUnitParameters& parameters);
  ~ControlUnit();
  ControlUnit(ControlUnit&& other) noexcept;
  ControlUnit& operator=(ControlUnit&& other) noexcept;
  /// A unit in the same condition: with the same inputs, both continue bitwise identically.
  /// Not real-time safe.
  ControlUnit(const ControlUnit& other);
  /// Takes over condition and configuration of the other one; `state()` keeps its address.
  ControlUnit& operator=(const ControlUnit& other) noexcept;

  /// First half of a tick. The reference stays valid for the unit's life. The first sample after
  /// the start or a restart gives gravity as tau_J and no external torque; a sample that is not
  /// finite is replaced by the last finite pose at rest.
  const franka_core::RobotState& observe(const ArmMeasurement& measurement) noexcept;

  /// Second half: the motor torques for the next tick [Nm]: the present control law, saturated,
  /// plus gravity of the configured load.
  /// @param command nullptr if none arrived: motion generators then continue with the same
  /// acceleration, and the last torque is held. With reflexes, a motion ends after a command that
  /// is not finite or not within the limits, and after 20 lost commands in a row, except with the
  /// asynchronous generator, whose targets come at any time; without reflexes, a torque that is not
  /// finite counts as a lost command.
  const std::array<double, 7>& actuate(const franka_core::RobotCommand* command) noexcept;

  /// The state of this tick. Real-time safe.
  const franka_core::RobotState& state() const noexcept;
  /// The model's quantities of the last measurement, frame EE.
  const franka_core::ArmDynamics& dynamics() const noexcept;

  /// Makes a request. @returns its answer, or nothing if takeAnswer() returns it later.
  ///
  /// Every request that the present mode does not allow: kCommandNotPossibleRejected. Setters are
  /// refused in Move with the rules of the FCI, but not with those of ros_control; invalid values
  /// (Configuration::apply, CommandFilter, VirtualWalls): kInvalidArgumentRejected.
  ///
  /// * Move: kMotionStarted, then takeAnswer(kMotion) returns the end (for a Cartesian motion at a
  ///   singular pose: kStartAtSingularPoseRejected, at once). Not possible outside Idle, while the
  ///   arm still brakes, or with the FCI inactive. kInvalidArgumentRejected for deviations or
  ///   velocities that are not positive, or if controller and generator cannot be combined.
  ///   The end: kSuccess, kPreempted (both once the arm rests), kStartAtSingularPoseRejected,
  ///   kReflexAborted, kEmergencyAborted (user stop), kAborted (guiding, brakes, FCI inactive).
  /// * StopMove: ends the motion (kPreempted) and brakes; no answer at once. takeAnswer(kStop):
  ///   kSuccess once the arm rests, or kReflexAborted, kEmergencyAborted, kAborted before.
  /// * AutomaticErrorRecovery: in Reflex clears errors and latched collisions once the arm stands
  ///   still; no answer at once. takeAnswer(kRecovery): kSuccess, kEmergencyAborted, or kAborted
  ///   (guiding, brakes, no standstill within 5 s). In Idle: kSuccess. While the user stop is
  ///   pressed or a joint is beyond its limits: kManualErrorRecoveryRequiredRejected. Not possible
  ///   in Move and Guiding (FCI only; with ros_control it clears latched contacts) and with closed
  ///   brakes.
  /// * SetGuidingMode: the axes of K along which the user may move the arm, and whether the elbow
  ///   is free. Initially all are free.
  std::optional<Status> request(const UnitRequest& request) noexcept;
  /// The answer to an earlier request, returned once.
  std::optional<Status> takeAnswer(PendingAnswer which) noexcept;

  /// Call after the arm was moved to another pose (reset, teleport): clears velocities, filters,
  /// commands and collisions, and holds the new pose. A motion of a generator ends (kAborted),
  /// because its path does not start there; answers that wait for the arm to come to rest are given
  /// as at rest. Otherwise the mode and the configuration stay.
  void restart() noexcept;

  /// Whether no Cartesian motion could start where the arm would come to rest if it was stopped
  /// now (kStartAtSingularPoseRejected). Real-time safe.
  bool stopsAtSingularPose() const noexcept;
  /// What clients and operators see of it. Real-time safe.
  UnitStatus status() const noexcept;
  /// The parameters with the changes by requests.
  const ControlUnitParameters& configuration() const noexcept;
  /// The limits of motions (franka_core/motion_limits.h).
  const franka_core::MotionLimits& limits() const noexcept;
  /// The virtual wall with that number; nullptr if there is no such number. See VirtualWalls.
  const franka_core::fci::CartesianLimit* virtualWall(std::int32_t id) const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// One line for the user that describes a robot's mode and errors: `panda: Reflex,
/// cartesian_reflex`. Not real-time safe.
std::string conditionText(const std::string& name, const franka_core::RobotState& state);

}  // namespace franka_sim
