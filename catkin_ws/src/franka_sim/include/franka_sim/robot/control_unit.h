// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/cartesian_impedance.h>
#include <franka_sim/robot/collision.h>
#include <franka_sim/robot/command_filter.h>
#include <franka_sim/robot/contact_monitor.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/error_flag.h>
#include <franka_sim/robot/external_torque.h>
#include <franka_sim/robot/external_wrench.h>
#include <franka_sim/robot/force_watch.h>
#include <franka_sim/robot/joint_impedance.h>
#include <franka_sim/robot/loss_monitor.h>
#include <franka_sim/robot/low_pass.h>
#include <franka_sim/robot/mode_machine.h>
#include <franka_sim/robot/motion/brake_trajectory.h>
#include <franka_sim/robot/motion/motion_generator.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/self_collision.h>
#include <franka_sim/robot/threshold_phase.h>
#include <franka_sim/robot/torque_blend.h>
#include <franka_sim/robot/torque_command.h>
#include <franka_sim/robot/virtual_walls.h>

#include <array>
#include <cstdint>
#include <optional>

namespace franka_sim {

/// The answer to a setter; the numbers are the unit's own, each face maps them to its protocol.
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
/// What takes time is answered later: how a motion, a stop or a recovery ended is taken with the
/// functions take...(), each told once.
///
/// One thread owns a unit; nothing in it locks, allocates, logs, throws (but for the constructor)
/// or asks a clock, so the same inputs give the same states bit for bit. Frames and units:
/// franka_core::RobotState.
class ControlUnit {
 public:
  using Status = franka_core::fci::Status;
  using MoveRequest = franka_core::fci::MoveRequest;

  /// Starts in Idle and holds the pose of the first measurement.
  /// @throws std::invalid_argument with a sentence that names the parameter which makes no sense.
  explicit ControlUnit(const ControlUnitParameters& parameters);

  // --- a tick ---

  /// First half of a tick. The reference stays valid until the next call.
  /// The first sample after the start or a restart has no tick of motor torques behind it: tau_J
  /// then shows gravity, as the sensor of a resting arm does, and no external torque is told. A
  /// sample that is not finite is replaced by the last good pose at rest.
  const franka_core::RobotState& observe(const ArmMeasurement& measurement) noexcept;

  /// Second half: the motor torques for the coming tick [Nm]: the present control law, saturated,
  /// plus gravity of the configured load and friction compensation.
  /// @param command nullptr when none arrived: motion generators then go on with the same
  /// acceleration, the last torque is held. With reflexes, a command that is not finite or not
  /// within the limits ends the motion, as do 20 lost in a row, but for the asynchronous generator,
  /// whose targets come when they come; without, a torque that is not finite counts as none.
  const std::array<double, 7>& actuate(const franka_core::RobotCommand* command) noexcept;

  /// Whether the joints are locked (UserStopped, Other). To be asked after `actuate`.
  bool brakesClosed() const noexcept { return modes_.brakesClosed(); }

  const franka_core::RobotState& state() const noexcept { return state_; }

  // --- motions ---

  /// Idle -> Move. @returns kMotionStarted, after which takeMotionEnd() tells the end (for a
  /// Cartesian motion at a singular pose: kStartAtSingularPoseRejected, at once);
  /// kCommandNotPossibleRejected in another mode, while the arm still brakes, or with the interface
  /// switched off; kInvalidArgumentRejected for deviations or velocities that are not positive, or
  /// a controller and a generator that do not go together.
  Status startMotion(const MoveRequest& request) noexcept;
  /// Ends a motion (Preempted) and brakes. Answers when the arm rests: see takeStopEnd.
  /// @returns kCommandNotPossibleRejected when there is no motion, else nothing yet.
  std::optional<Status> stopMove() noexcept;
  /// kSuccess, kPreempted (both once the arm rests), kStartAtSingularPoseRejected, kReflexAborted,
  /// kEmergencyAborted (user stop), kAborted (guiding, brakes, interface switched off).
  std::optional<Status> takeMotionEnd() noexcept;
  /// kSuccess, or kReflexAborted, kEmergencyAborted, kAborted when that came first.
  std::optional<Status> takeStopEnd() noexcept;

  /// Clears errors and latched collisions once the arm stands still. @returns nothing if that has
  /// begun; kSuccess if there is no error; kManualErrorRecoveryRequiredRejected while the user stop
  /// is pressed or a joint stands beyond its limits; kCommandNotPossibleRejected in Move, Guiding
  /// and with closed brakes.
  std::optional<Status> startErrorRecovery() noexcept;
  /// kSuccess, kEmergencyAborted (user stop), kAborted (guiding, brakes, or no standstill within
  /// 5 s).
  std::optional<Status> takeRecoveryEnd() noexcept;

  /// Nobody sends commands to the motion that runs any more. One of the asynchronous generator, in
  /// which a client may be silent for as long as it likes, then ends as others do: after 20 lost
  /// in a row.
  void clientGone() noexcept { move_.use_async_motion_generator = false; }

  /// Time must go on though no client answers: the arm brakes or recovers.
  bool settling() const noexcept;
  /// Whether the end of a motion or of a stop is answered only once the arm has come to rest.
  bool owesAnswers() const noexcept { return motion_end_at_rest_.has_value() || stopping_; }
  /// Which links came too close, after self_collision_avoidance_violation.
  const SelfCollision::Pair& selfCollisionPair() const noexcept {
    return self_collision_.culprit();
  }
  /// What joint_reflex and cartesian_reflex were raised for, until they are recovered from.
  const Collision& jointCollision() const noexcept { return joint_collision_; }
  const Collision& cartesianCollision() const noexcept { return cartesian_collision_; }
  /// The thresholds of contact and collision that held in this tick.
  const CollisionThresholds& thresholds() const noexcept {
    return in_acceleration_ ? parameters_.acceleration : parameters_.nominal;
  }

  /// The same without waiting, for the ROS simulation: external torque control without a motion
  /// generator; its end, from which on the arm brakes and is held; recovery, refused while the user
  /// stop is pressed.
  RequestStatus startTorqueControl() noexcept;
  RequestStatus stopMotion() noexcept;
  RequestStatus automaticErrorRecovery() noexcept;

  // --- hands on the robot ---

  /// The external activation device: pressed stops any motion and closes the brakes, released gives
  /// Idle (Reflex if there were errors).
  void setUserStop(bool pressed) noexcept;
  bool userStopPressed() const noexcept { return user_stop_; }
  /// The user takes the arm by its guiding buttons, or lets go.
  void setGuiding(bool active) noexcept;
  /// Closed brakes: mode Other.
  void closeBrakes() noexcept;
  void openBrakes() noexcept;
  /// Off: no motion can be asked for, and a running one is aborted.
  void setFciActive(bool active) noexcept;
  bool fciActive() const noexcept { return fci_active_; }

  // --- configuration ---

  /// NE_T_EE, EE_T_K: refused when not homogeneous (see isTransform).
  RequestStatus setEE(const std::array<double, 16>& NE_T_EE) noexcept;
  RequestStatus setK(const std::array<double, 16>& EE_T_K) noexcept;
  /// Refused when not finite, of negative mass, or with an inertia no body has (not symmetric, a
  /// negative principal moment).
  RequestStatus setLoad(const franka_core::Payload& load) noexcept;
  /// Refused when not finite or negative. A lower threshold may lie above the upper one: with
  /// reflexes there are then no contacts.
  RequestStatus setCollisionBehavior(const CollisionThresholds& acceleration,
                                     const CollisionThresholds& nominal) noexcept;
  /// Of the internal joint controller, 0 to 14250 [Nm/rad].
  RequestStatus setJointImpedance(const std::array<double, 7>& K_theta) noexcept;
  /// Of the internal Cartesian controller in the axes of K: 10 to 3000 [N/m], 1 to 300 [Nm/rad].
  RequestStatus setCartesianImpedance(const std::array<double, 6>& K_x) noexcept;
  /// Along and about which axes (x, y, z, R, P, Y of K) the user may lead the arm, and whether the
  /// elbow is free. At first all are.
  RequestStatus setGuidingMode(const std::array<bool, 6>& free, bool elbow) noexcept;
  /// Cutoffs of 1 to 1000 [Hz].
  RequestStatus setFilters(const franka_core::fci::SetFiltersRequest& cutoffs) noexcept;
  /// The virtual wall of that number, and its change from outside (Desk); see VirtualWalls.
  const franka_core::fci::CartesianLimit* virtualWall(std::int32_t id) const noexcept {
    return walls_.get(id);
  }
  RequestStatus setVirtualWall(std::int32_t id,
                               const franka_core::fci::CartesianLimit& wall) noexcept;
  /// Whose limits hold from the next motion on; refused in Move and for numbers but 3 to 10.
  RequestStatus setProtocolVersion(unsigned version) noexcept;

  /// After the arm was put elsewhere (reset, teleport): forgets velocities, filters, commands and
  /// collisions, and holds the new pose. A motion of a generator, whose way does not lead from
  /// there, ends (kAborted); what waits for the arm to come to rest is answered as at rest. Else
  /// the mode and the configuration stay.
  void restart() noexcept;

  /// The configuration as the setters left it.
  const ControlUnitParameters& parameters() const noexcept { return parameters_; }
  /// What motions are held to.
  const MotionLimits& limits() const noexcept { return generator_.limits(); }

 private:
  enum class Rest { kBraking, kReleasing, kReached };

  franka_core::RobotMode mode() const noexcept { return modes_.mode(); }
  bool generates() const noexcept;
  bool controlledOutside() const noexcept;
  bool settersAllowed() const noexcept;

  // observe
  void beginHere() noexcept;
  void observeTorques(const ArmMeasurement& measurement, bool measured) noexcept;
  void observeContacts() noexcept;
  void observeAccelerometers(const std::array<double, 7>& dq_before) noexcept;
  void observeDesired() noexcept;
  void checkMeasurement() noexcept;
  void checkMotion() noexcept;
  void checkContacts() noexcept;

  // actuate
  void advanceMotion(const franka_core::RobotCommand* command) noexcept;
  bool takeTorque(const franka_core::RobotCommand& command) noexcept;
  void advanceRest() noexcept;
  void advanceRecovery() noexcept;
  std::array<double, 7> controlLaw() noexcept;
  std::array<double, 7> cartesianLaw(const std::array<double, 6>& K,
                                     double nullspace) const noexcept;

  // transitions
  void flag(std::size_t error) noexcept;
  void react() noexcept;
  void finishMotion() noexcept;
  void endMotion(ModeEvent event, Status status, bool at_rest) noexcept;
  void atRest() noexcept;
  bool handle(ModeEvent event) noexcept;
  void enter(franka_core::RobotMode before) noexcept;
  void settle() noexcept;
  void clearErrors() noexcept;
  void clearContacts() noexcept;
  void brake() noexcept;
  void holdHere() noexcept;
  void showDesired(const DesiredMotion& desired) noexcept;
  void showModes() noexcept;
  void showConfiguration() noexcept;

  ControlUnitParameters parameters_;
  franka_core::Payload total_;  // end effector and load
  franka_core::RobotState state_;
  ModeMachine modes_;
  bool user_stop_{false};
  bool fci_active_{true};

  bool started_{false};                  // a measurement has been seen since the start or restart
  bool continuous_{false};               // the last sample was a good one of the same motion
  bool desired_stale_{true};             // q_d or the frames have changed
  franka_core::ArmDynamics dynamics_{};  // at the last measurement, frame EE
  std::array<double, 7> tau_ext_{};      // unfiltered
  std::array<double, 6> wrench_{};       // likewise, in the axes of the thresholds
  std::array<double, 6> O_dP_EE_{};      // measured
  ExternalTorque external_torque_;
  ExternalWrench external_wrench_;
  LowPass<7> tau_ext_filter_, dtau_J_filter_;
  ContactMonitor<7> joint_contacts_;
  ContactMonitor<6> cartesian_contacts_;
  ThresholdPhase phase_;
  bool in_acceleration_{false};  // those thresholds hold
  Collision joint_collision_, cartesian_collision_;
  ForceWatch force_watch_;
  SelfCollision self_collision_;
  VirtualWalls walls_;

  MoveRequest move_;
  MotionGenerator generator_;
  bool accelerating_{false};
  CommandFilter filter_;
  TorqueCommand torque_command_;
  LossMonitor losses_;
  BrakeTrajectory brake_;
  Rest rest_{Rest::kReached};
  int rest_ticks_{0};
  int recovery_ticks_{0}, still_ticks_{0};

  JointImpedance hold_, joint_controller_;
  std::array<bool, 6> guiding_free_{{true, true, true, true, true, true}};
  bool guiding_elbow_{true};
  std::array<double, 16> guiding_pose_{};
  std::array<double, 7> guiding_q_{};
  TorqueBlend blend_;
  std::array<double, 7> law_{};  // what acted in this tick, without gravity
  std::array<double, 7> motor_torque_{};

  std::optional<Status> motion_end_, stop_end_, recovery_end_;
  std::optional<Status> motion_end_at_rest_;
  bool stopping_{false};  // somebody waits for the end of stopMove
};

}  // namespace franka_sim
