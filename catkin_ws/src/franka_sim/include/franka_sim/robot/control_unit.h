// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/motion/motion_limits.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/unit_requests.h>
#include <franka_sim/robot/unit_status.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

namespace franka_sim {

/// What Franka's control cabinet does, once a millisecond.
///
/// A tick has two halves: `observe` turns a measurement into state k; `actuate` takes the command
/// that answers state k (or none) and gives the torques that act until k+1. Requests are made
/// between these calls. A request shows in `state()` at once where it sets a mode or a
/// configuration; what is computed from them follows with the next `observe`.
///
/// Its parts: StateEstimator, MotionSupervisor, ControlLaws. One thread owns a unit. But for the
/// constructor: Real-time safe. Nothing in it asks a clock, so the same inputs give the same states
/// bit for bit. Frames and units: franka_core::RobotState.
class ControlUnit {
 public:
  /// Starts in Idle and holds the pose of the first measurement.
  /// @throws std::invalid_argument with a sentence that names the parameter which makes no sense.
  explicit ControlUnit(const ControlUnitParameters& parameters);
  ~ControlUnit();
  ControlUnit(ControlUnit&& other) noexcept;
  ControlUnit& operator=(ControlUnit&& other) noexcept;

  /// First half of a tick. The reference stays valid for the unit's life. The first sample after
  /// the start or a restart shows gravity as tau_J and no external torque; a sample that is not
  /// finite is replaced by the last good pose at rest.
  const franka_core::RobotState& observe(const ArmMeasurement& measurement) noexcept;

  /// Second half: the motor torques for the coming tick [Nm]: the present control law, saturated,
  /// plus gravity of the configured load and friction compensation.
  /// @param command nullptr when none arrived: motion generators then go on with the same
  /// acceleration, the last torque is held. With reflexes, a command that is not finite or not
  /// within the limits ends the motion, as do 20 lost in a row, but for the asynchronous generator,
  /// whose targets come at any time; without reflexes, a torque that is not finite counts as none.
  const std::array<double, 7>& actuate(const franka_core::RobotCommand* command) noexcept;

  const franka_core::RobotState& state() const noexcept;

  /// Makes a request. @returns how it is answered, or nothing where takeAnswer() tells it later.
  ///
  /// Every request that the present mode does not allow: kCommandNotPossibleRejected. Setters are
  /// refused in Move over the FCI, not under ros_control; bad values (Configuration::apply,
  /// CommandFilter, VirtualWalls): kInvalidArgumentRejected.
  ///
  /// * Move: kMotionStarted, after which takeAnswer(kMotion) tells the end (for a Cartesian motion
  ///   at a singular pose: kStartAtSingularPoseRejected, at once). Not possible outside Idle, while
  ///   the arm still brakes, or with the FCI inactive. kInvalidArgumentRejected for deviations or
  ///   velocities that are not positive, or a controller and a generator that do not go together.
  ///   The end: kSuccess, kPreempted (both once the arm rests), kStartAtSingularPoseRejected,
  ///   kReflexAborted, kEmergencyAborted (user stop), kAborted (guiding, brakes, FCI inactive).
  /// * StopMove: ends the motion (Preempted) and brakes; nothing at once. takeAnswer(kStop):
  ///   kSuccess once the arm rests, or kReflexAborted, kEmergencyAborted, kAborted before.
  /// * AutomaticErrorRecovery: in Reflex clears errors and latched collisions once the arm stands
  ///   still, nothing at once; takeAnswer(kRecovery): kSuccess, kEmergencyAborted, or kAborted
  ///   (guiding, brakes, no standstill within 5 s). In Idle: kSuccess. While the user stop is
  ///   pressed or a joint stands beyond its limits: kManualErrorRecoveryRequiredRejected. Not
  ///   possible in Move and Guiding (FCI only; ros_control clears what contacts it has) and with
  ///   closed brakes.
  /// * SetGuidingMode: the axes of K along which the user may lead the arm, and whether the elbow
  /// is
  ///   free. At first all are.
  std::optional<Status> request(const UnitRequest& request) noexcept;
  /// The answer to an earlier request, once.
  std::optional<Status> takeAnswer(PendingAnswer which) noexcept;

  /// After the arm was put elsewhere (reset, teleport): forgets velocities, filters, commands and
  /// collisions, and holds the new pose. A motion of a generator, whose way does not lead from
  /// there, ends (kAborted); what waits for the arm to come to rest is answered as at rest. Else
  /// the mode and the configuration stay.
  void restart() noexcept;

  UnitStatus status() const noexcept;
  /// As requests have changed it.
  const ControlUnitParameters& configuration() const noexcept;
  /// What motions are held to.
  const MotionLimits& limits() const noexcept;
  /// The virtual wall of that number; nullptr if there is no such number. See VirtualWalls.
  const franka_core::fci::CartesianLimit* virtualWall(std::int32_t id) const noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace franka_sim
