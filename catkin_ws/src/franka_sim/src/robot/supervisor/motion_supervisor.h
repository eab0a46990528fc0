// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/fixed_pointer.h>

#include <array>
#include <optional>

#include "robot/configuration.h"
#include "robot/estimator/state_estimator.h"
#include "robot/laws/control_task.h"
#include "robot/motion/rest_sequence.h"
#include "robot/safety/safety_monitor.h"
#include "robot/safety/threshold_phase.h"
#include "robot/supervisor/client_motion.h"
#include "robot/supervisor/desired_state.h"
#include "robot/supervisor/joint_brakes.h"
#include "robot/supervisor/mode_machine.h"
#include "robot/supervisor/pending_answers.h"

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
  Answer handle(const ContinuedMove& request) noexcept;
  Answer handle(const ClientLost& request) noexcept;
  Answer take(PendingAnswer which) noexcept { return answers_.take(which); }

  /// See ControlUnit::stopsAtSingularPose.
  bool stopsAtSingularPose() const noexcept;
  /// The arm was moved to another pose, see ControlUnit::restart.
  void restart() noexcept;
  /// Frames or loads have changed: the desired pose is computed again.
  void framesChange() noexcept { desired_.invalidate(); }
  /// The limits of the configured protocol version apply from the next motion on.
  void limitsChange() noexcept;

  bool isMoving() const noexcept { return mode() == franka_core::RobotMode::kMove; }
  bool generates() const noexcept { return motion_.hasGenerator(); }
  bool acceptsSetters() const noexcept;
  bool brakesClosed() const noexcept { return brakes_.closed(); }
  UnitStatus status() const noexcept;
  const franka_core::MotionLimits& limits() const noexcept { return motion_.limits(); }
  const VirtualWalls& walls() const noexcept { return safety_.walls(); }

 private:
  franka_core::RobotMode mode() const noexcept { return modes_.mode(); }
  bool hasReflexes() const noexcept { return configuration_->hasReflexes(); }
  const CollisionThresholds& thresholds() const noexcept;

  // a tick
  void advanceMotion(const franka_core::RobotCommand* command) noexcept;
  void advanceRest() noexcept;
  void advanceRecovery() noexcept;
  void advanceBrakes() noexcept;
  bool rests() const noexcept;

  // transitions
  Answer startMotion(const franka_core::fci::MoveRequest& request, bool continued) noexcept;
  Answer recover() noexcept;
  void react() noexcept;
  void endMotion(ModeEvent event, Status status, bool at_rest) noexcept;
  void atRest() noexcept;
  bool change(ModeEvent event) noexcept;
  void enter(franka_core::RobotMode before) noexcept;
  void settle() noexcept;
  void clearMotionData() noexcept;
  void clearErrors() noexcept;
  void brake(RestSequence& rest) const noexcept;
  void stopAndClose() noexcept;
  void leaveStop(ModeEvent event) noexcept;
  void leaveReleasedStop() noexcept;
  void holdPosition() noexcept;
  void guideFromHere() noexcept;
  void writeModes() noexcept;

  FixedPointer<const Configuration> configuration_;
  FixedPointer<StateEstimator> estimator_;
  FixedPointer<franka_core::RobotState> state_;

  ModeMachine modes_;
  struct OperatorInputs {
    bool user_stop{false}, close_brakes{false}, fci_active{true};
  } operator_;
  SafetyMonitor safety_;
  ThresholdPhase phase_;
  PendingAnswers answers_;

  ClientMotion motion_;
  DesiredState desired_;
  RestSequence rest_;
  int recovery_ticks_{0};
  JointBrakes brakes_;
  GuidingTask guiding_;
  LawSwitch law_switch_{LawSwitch::kNone};
};

}  // namespace franka_sim
