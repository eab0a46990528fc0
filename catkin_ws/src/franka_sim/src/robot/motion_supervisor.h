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
#include "robot/motion/command_filter.h"
#include "robot/motion/motion_generator.h"
#include "robot/motion/rest_sequence.h"
#include "robot/safety/loss_monitor.h"
#include "robot/safety/safety_monitor.h"
#include "robot/safety/threshold_phase.h"
#include "robot/safety/virtual_walls.h"

namespace franka_sim {

/// The desired motion in the robot's state: q_d, O_T_EE_d, elbow_d and so on. Called by one thread.
/// Real-time safe.
class DesiredState {
 public:
  /// @param state outlives this.
  explicit DesiredState(franka_core::RobotState& state) noexcept : state_(&state) {}

  /// Sets the joints [rad, rad/s, rad/s^2]; the next update() computes the other fields.
  void set(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
           const std::array<double, 7>& ddq_d) noexcept;
  /// Sets all fields.
  void set(const DesiredMotion& desired) noexcept;
  /// Frames or loads have changed.
  void invalidate() noexcept { stale_ = true; }
  /// Computes the other fields again if the joints or frames have changed.
  void update(const franka_core::ArmModel& model) noexcept;

 private:
  FixedPointer<franka_core::RobotState> state_;
  bool stale_{true};
};

/// A motion that a client commands: the Move request, its generator, filters and torques, and the
/// count of its commands. Called by one thread. Real-time safe.
class ClientMotion {
 public:
  /// @param max_torque of the motors [Nm]
  ClientMotion(const MotionLimits& limits, const std::array<double, 7>& max_torque) noexcept
      : generator_(limits), torque_(max_torque) {}

  /// Starts the generator, if the request has one. Nothing changes if that is refused.
  /// @param continued whether it may also start at a singular pose
  MotionStartResult start(const franka_core::fci::MoveRequest& request, bool continued,
                          const franka_core::RobotState& state,
                          const franka_core::ArmModel& model) noexcept;
  /// Filters begin at the desired motion of the state.
  void beginFilters(const franka_core::RobotState& state) noexcept { filter_.begin(state); }

  struct Step {
    ErrorSet errors;
    bool generated{false};  ///< desired() is new
    bool finished{false};   ///< by the client
  };
  /// One tick. @param command nullptr if none arrived @param reflexes whether lost commands and
  /// steps of torque are errors; without them, commands with torques that are not finite are lost
  Step step(const franka_core::RobotCommand* command, bool reflexes,
            const franka_core::ArmModel& model) noexcept;

  /// The client is lost: from now on, missing commands count.
  void clientIsLost() noexcept { request_.use_async_motion_generator = false; }
  /// Torques and counts belong to one motion.
  void clear() noexcept;
  /// From the next motion on.
  void setLimits(const MotionLimits& limits) noexcept { generator_ = MotionGenerator(limits); }
  CommandFilter& filter() noexcept { return filter_; }

  const franka_core::fci::MoveRequest& request() const noexcept { return request_; }
  bool hasGenerator() const noexcept;
  bool hasExternalController() const noexcept;
  const DesiredMotion& desired() const noexcept { return generator_.desired(); }
  const std::array<double, 7>& torque() const noexcept { return torque_.value(); }  ///< [Nm]
  double successRate() const noexcept { return losses_.rate(); }
  const MotionLimits& limits() const noexcept { return generator_.limits(); }

 private:
  franka_core::fci::MoveRequest request_;
  MotionGenerator generator_;
  CommandFilter filter_;
  TorqueCommand torque_;
  LossMonitor losses_;
};

/// The joints' brakes, which close on an arm that has come to rest (a stop of category 1,
/// IEC 60204-1). Called by one thread. Real-time safe.
class JointBrakes {
 public:
  bool closed() const noexcept { return closed_; }
  void open() noexcept { closed_ = false; }
  /// Begins to close them: at once if the arm rests.
  void close(bool rests) noexcept;
  /// One tick of an arm that is to come to rest. @returns whether it has been resting for a while
  bool hasComeToRest(bool rests) noexcept;
  /// One tick of brakes that wait for the arm, which no longer brakes by its motors.
  void step(bool rests) noexcept;
  /// Begins to count again. @param closed whether the brakes are closed
  void restart(bool closed) noexcept;

 private:
  bool closed_{false};
  int ticks_{0};          // since the end of braking
  int resting_ticks_{0};  // in a row
};

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
  const MotionLimits& limits() const noexcept { return motion_.limits(); }
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
