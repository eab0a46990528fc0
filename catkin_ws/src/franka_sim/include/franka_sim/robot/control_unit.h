// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/plant.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>

/// @file
/// The requests of a control unit: those of the FCI, and those of the operator or the server. Their
/// answers: ControlUnit::request.

namespace franka_core {
struct MotionLimits;
}

namespace franka_sim {

using Status = franka_core::fci::Status;  ///< of the answer to a request

/// The external activation device: pressed stops any motion and closes the brakes; released leads
/// to Idle, or to Reflex if there were errors.
struct UserStop {
  bool pressed;  ///< otherwise released
};
/// The user starts or ends guiding of the arm with its guiding buttons.
struct Guiding {
  bool active;  ///< otherwise not
};
/// Closed brakes: mode Other.
struct Brakes {
  bool closed;  ///< otherwise open
};
/// Inactive: no motion can be requested, and a running one is aborted.
struct FciActivation {
  bool active;  ///< otherwise not
};
/// A motion that the operator commands by Desk: a Move that needs no FCI.
struct OperatorMove {
  franka_core::fci::MoveRequest move;  ///< its request
};
/// A motion that goes on after a stop, with another controller: a Cartesian one also at a singular
/// pose.
struct ContinuedMove {
  franka_core::fci::MoveRequest move;  ///< its request
};
/// The end effector as it is set in Desk. Refused in Move, and if no arm can hold it.
struct SetEndEffector {
  franka_core::Payload payload;   ///< m_ee, F_x_Cee, I_ee
  std::array<double, 16> F_T_NE;  ///< 4x4, column-major
};
/// Sets one of the virtual walls.
struct SetVirtualWall {
  std::int32_t id;                        ///< number of the wall, 0 to 7
  franka_core::fci::CartesianLimit wall;  ///< its box
};
/// The version, 3 to 10, whose limits apply from the next motion on.
struct SetProtocolVersion {
  unsigned version;  ///< of the protocol
};
/// The running motion gets no more commands. A motion of the asynchronous generator, in which a
/// client may be silent for any time, then ends as others do: after 20 lost commands in a row.
struct ClientLost {};

/// Any request of a control unit.
using UnitRequest = std::variant<
    franka_core::fci::MoveRequest, franka_core::fci::StopMoveRequest,
    franka_core::fci::AutomaticErrorRecoveryRequest, franka_core::fci::SetCollisionBehaviorRequest,
    franka_core::fci::SetJointImpedanceRequest, franka_core::fci::SetCartesianImpedanceRequest,
    franka_core::fci::SetGuidingModeRequest, franka_core::fci::SetEEToKRequest,
    franka_core::fci::SetNEToEERequest, franka_core::fci::SetLoadRequest,
    franka_core::fci::SetFiltersRequest, UserStop, Guiding, Brakes, FciActivation, OperatorMove,
    ContinuedMove, SetEndEffector, SetVirtualWall, SetProtocolVersion, ClientLost>;

/// The requests that are answered later than they are made.
enum class PendingAnswer {
  kMotion,    ///< the result of a motion
  kStop,      ///< the arm rests after StopMove
  kRecovery,  ///< the result of an error recovery
};

/// The request of a client for this load.
inline franka_core::fci::SetLoadRequest loadRequest(const franka_core::Payload& load) noexcept {
  return {load.mass, load.com, load.inertia};
}

/// The request of a client for these thresholds.
inline franka_core::fci::SetCollisionBehaviorRequest collisionRequest(
    const CollisionThresholds& acceleration, const CollisionThresholds& nominal) noexcept {
  return {acceleration.lower_torque, acceleration.upper_torque, nominal.lower_torque,
          nominal.upper_torque,      acceleration.lower_force,  acceleration.upper_force,
          nominal.lower_force,       nominal.upper_force};
}

/// A Move request for torques of an external controller without a motion generator.
inline franka_core::fci::MoveRequest torqueControl() noexcept {
  franka_core::fci::MoveRequest request;
  request.controller_mode = franka_core::ControllerMode::kExternalController;
  request.motion_generator_mode = franka_core::MotionGeneratorMode::kNone;
  return request;
}

/// Status of a control unit that is not part of franka_core::RobotState.
struct UnitStatus {
  bool brakes_closed{false};  ///< the joints are locked (UserStopped, Other, once the arm rests)
  bool close_brakes{false};   ///< the brakes' switch, whatever the mode
  bool user_stop_pressed{false};  ///< the button's state, whatever the mode
  bool fci_active{true};          ///< clients may control the arm
  bool measured{false};  ///< the arm was observed since the start or restart: motions can start
  /// Time must advance even if no client answers: the arm brakes or recovers.
  bool settling{false};
  /// No joint moves, or so slowly that a sensor would not see it.
  bool resting{false};
  /// The end of a motion or of a stop is answered only after the arm has come to rest.
  bool answers_at_rest{false};
  /// The thresholds of contact and collision in this tick.
  CollisionThresholds thresholds;
  /// The causes of joint_reflex and cartesian_reflex, until their recovery.
  Collision joint_collision, cartesian_collision;
  /// The links that came too close; valid after self_collision_avoidance_violation.
  LinkPair self_collision;
};

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
