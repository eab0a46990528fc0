// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/fixed_pointer.h>

#include <array>
#include <optional>

#include "robot/configuration.h"
#include "robot/estimator/state_estimator.h"
#include "robot/laws/control_laws.h"
#include "robot/mode_machine.h"
#include "robot/motion/motion_generator.h"
#include "robot/safety/safety_monitor.h"

namespace franka_sim {

/// Controls modes, motions and their commands, stops, reflexes and recovery. Writes the modes,
/// errors and desired fields of the robot's state.
///
/// Called by one thread. Real-time safe.
class MotionSupervisor {
 public:
  using Answer = std::optional<Status>;  ///< nothing: answered later

  /// @param configuration, estimator, state outlive the supervisor.
  MotionSupervisor(const Configuration& configuration, StateEstimator& estimator,
                   franka_core::RobotState& state) noexcept;

  // --- a tick ---

  /// @returns the collision thresholds of this tick.
  const CollisionThresholds& beginTick() noexcept;
  /// First half: checks the state that the estimator has just updated.
  /// @param motor_torques of the tick that led to it [Nm]
  void checkState(const std::array<double, 7>& motor_torques) noexcept;
  /// Second half: takes the command that answers the state, or nullptr if none arrived.
  void advance(const franka_core::RobotCommand* command) noexcept;
  /// The task of the control laws; a switch of the law is returned once.
  ControlTask takeTask() noexcept;

  // --- requests, see ControlUnit::request ---

  Answer handle(const franka_core::fci::MoveRequest& request) noexcept;
  Answer handle(const franka_core::fci::StopMoveRequest& request) noexcept;
  Answer handle(const franka_core::fci::AutomaticErrorRecoveryRequest& request) noexcept;
  Answer handle(const franka_core::fci::SetGuidingModeRequest& request) noexcept;
  Answer handle(const franka_core::fci::SetFiltersRequest& request) noexcept;
  Answer handle(const SetVirtualWall& request) noexcept;
  Answer handle(const UserStop& request) noexcept;
  Answer handle(const Guiding& request) noexcept;
  Answer handle(const Brakes& request) noexcept;
  Answer handle(const FciActivation& request) noexcept;
  Answer handle(const OperatorMove& request) noexcept;
  Answer handle(const ClientLost& request) noexcept;
  Answer take(PendingAnswer which) noexcept { return answers_.take(which); }

  /// The arm was moved to another pose, see ControlUnit::restart.
  void restart() noexcept;
  /// Frames or loads have changed: the desired pose is computed again.
  void framesChange() noexcept { desired_stale_ = true; }
  /// The limits of the configured protocol version apply from the next motion on.
  void limitsChange() noexcept;

  bool isMoving() const noexcept { return mode() == franka_core::RobotMode::kMove; }
  bool generates() const noexcept;
  bool acceptsSetters() const noexcept;
  bool brakesClosed() const noexcept { return brakes_closed_; }
  UnitStatus status() const noexcept;
  const MotionLimits& limits() const noexcept { return generator_.limits(); }
  const VirtualWalls& walls() const noexcept { return safety_.walls(); }

 private:
  franka_core::RobotMode mode() const noexcept { return modes_.mode(); }
  bool hasReflexes() const noexcept { return configuration_->hasReflexes(); }
  bool controlledOutside() const noexcept;
  const CollisionThresholds& thresholds() const noexcept;
  const franka_core::ArmLimits& brakingLimits() const noexcept { return generator_.limits().arm; }

  // a tick
  void initializeFromMeasurement() noexcept;
  void updateDesired() noexcept;
  void advanceMotion(const franka_core::RobotCommand* command) noexcept;
  const franka_core::RobotCommand* receive(const franka_core::RobotCommand* command) noexcept;
  bool advanceGenerator(const franka_core::RobotCommand* command) noexcept;
  bool takeTorque(const franka_core::RobotCommand& command) noexcept;
  void finishMotion() noexcept;
  void advanceRest() noexcept;
  void advanceRecovery() noexcept;
  void advanceBrakes() noexcept;
  bool hasComeToRest() noexcept;
  bool standsStill() const noexcept;

  // transitions
  Answer startMotion(const franka_core::fci::MoveRequest& request) noexcept;
  MotionStartResult startGenerator(const franka_core::fci::MoveRequest& request) noexcept;
  Answer recover() noexcept;
  Answer recoverWithoutReflex() noexcept;
  void react() noexcept;
  void endMotion(ModeEvent event, Status status, bool at_rest) noexcept;
  void atRest() noexcept;
  bool change(ModeEvent event) noexcept;
  void enter(franka_core::RobotMode before) noexcept;
  void enterMove() noexcept;
  void settle() noexcept;
  void clearMotionData() noexcept;
  void clearErrors() noexcept;
  void brake() noexcept;
  void stopAndClose() noexcept;
  void leaveStop(ModeEvent event) noexcept;
  void holdPosition() noexcept;
  void followArm() noexcept;
  void guideFromHere() noexcept;
  void showJoints(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                  const std::array<double, 7>& ddq) noexcept;
  void showDesired(const DesiredMotion& desired) noexcept;
  void showModes() noexcept;

  FixedPointer<const Configuration> configuration_;
  FixedPointer<StateEstimator> estimator_;
  FixedPointer<franka_core::RobotState> state_;

  ModeMachine modes_;
  bool user_stop_{false}, brakes_requested_{false};
  bool fci_active_{true};
  SafetyMonitor safety_;
  PendingAnswers answers_;

  franka_core::fci::MoveRequest move_;
  MotionGenerator generator_;
  CommandFilter filter_;
  TorqueCommand torque_command_;
  LossMonitor losses_;
  bool accelerating_{false};
  ThresholdPhase phase_;
  bool in_acceleration_{false};  // the thresholds of acceleration apply

  RestSequence rest_;
  int recovery_ticks_{0}, still_ticks_{0};
  bool brakes_closed_{false};
  int closing_ticks_{0};      // since the end of braking
  bool desired_stale_{true};  // q_d or the frames have changed
  GuidingTask guiding_;
  LawSwitch law_switch_{LawSwitch::kNone};
};

}  // namespace franka_sim
