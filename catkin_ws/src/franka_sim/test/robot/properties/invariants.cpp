// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "properties/invariants.h"

#include <franka_core/motion_limits.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <initializer_list>

namespace franka_sim::test {

namespace {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;
using franka_core::RobotState;
using Answer = SteppedRobot::Answer;

/// Parts as a set of bits.
constexpr unsigned setOf(std::initializer_list<Part> parts) {
  unsigned set = 0;
  for (const Part part : parts) {
    set |= 1U << static_cast<unsigned>(part);
  }
  return set;
}

/// What an action may change at once.
unsigned changedBy(Action action) {
  switch (action) {
    case Action::kWait:
    case Action::kSend:
    case Action::kClientLost:
    case Action::kLoseCommands:
    case Action::kSetJointImpedance:
    case Action::kSetFilters:
    case Action::kSpoilMeasurement:
    case Action::kPush:
      return 0;
    case Action::kMove:
    case Action::kStopMove:
    case Action::kRecover:
      return setOf({Part::kState, Part::kStatus});
    case Action::kOperatorMotion:
      return setOf({Part::kState, Part::kStatus, Part::kOperatorMotion});
    case Action::kSetLoad:
      return setOf({Part::kState, Part::kLoad});
    case Action::kSetEndEffector:
      return setOf({Part::kState, Part::kEndEffector, Part::kNominalFrame});
    case Action::kSetNEToEE:
      return setOf({Part::kState, Part::kEndEffectorFrame});
    case Action::kSetEEToK:
      return setOf({Part::kState, Part::kStiffnessFrame});
    case Action::kSetCollisionBehavior:
      return setOf({Part::kStatus, Part::kThresholds});
    case Action::kSetCartesianImpedance:
      return setOf({Part::kCartesianStiffness});
    case Action::kSetVirtualWall:
      return setOf({Part::kVirtualWalls});
    case Action::kSetProtocolVersion:
      return setOf({Part::kProtocolVersion});
    case Action::kGuidingMode:
      return setOf({Part::kSafety});
    case Action::kHand:
      return setOf({Part::kHand});
    case Action::kPower:
    case Action::kRestart:
      return ~0U;
    default:
      return setOf({Part::kState, Part::kStatus, Part::kSafety});
  }
}

bool isSetter(Action action) { return action >= Action::kSetLoad && action <= Action::kHand; }

bool anyError(const RobotState& state) {
  return std::find(state.errors.begin(), state.errors.end(), true) != state.errors.end();
}

bool isFinite(const RobotState& state) {
  constexpr std::size_t kNumbers = offsetof(RobotState, motion_generator_mode) / sizeof(double);
  std::array<double, kNumbers> numbers;
  std::memcpy(numbers.data(), &state, sizeof numbers);
  double sum = 0.0;                             // of zeros, unless a number is not finite
  for (std::size_t i = 1; i < kNumbers; i++) {  // the first one is message_id
    sum += 0.0 * numbers[i];
  }
  return sum == 0.0;
}

/// Whether a motion that ended in this mode may have this answer.
bool isAnswerIn(RobotMode mode, Status status) {
  const bool emergency = status == Status::kEmergencyAborted;
  switch (mode) {
    case RobotMode::kUserStopped:
      return emergency;
    case RobotMode::kReflex:
      return status == Status::kReflexAborted || status == Status::kPreempted;
    case RobotMode::kGuiding:
      return status == Status::kAborted;
    case RobotMode::kOther:
      return status == Status::kAborted || emergency;
    default:
      return !emergency && status != Status::kReflexAborted;
  }
}

/// Whether neither mode, desired motion nor errors differ.
bool sameMotion(const RobotState& a, const RobotState& b) {
  return a.robot_mode == b.robot_mode && a.motion_generator_mode == b.motion_generator_mode &&
         a.controller_mode == b.controller_mode && a.errors == b.errors && a.q_d == b.q_d &&
         a.dq_d == b.dq_d && a.ddq_d == b.ddq_d && a.tau_J_d == b.tau_J_d &&
         a.reflex_reason == b.reflex_reason;
}

}  // namespace

Invariants::Invariants(const SteppedRobot& robot)
    : robot_(robot), limits_(robot.robot().unit().limits().arm) {
  remember();
}

void Invariants::remember() { before_ = {robot_.state(), robot_.robot().unit().status()}; }

std::string Invariants::run(SteppedRobot& robot, const Step& step) {
  const Observation before = robot.observation();
  const RobotState last = robot.state();
  const UnitStatus was = robot.robot().unit().status();
  const Answer answer = robot.act(step);
  actions_++;
  if (answer == Answer::kDone) {
    const bool starts = step.action == Action::kMove ||
                        (step.action == Action::kOperatorMotion && step.variant < 20);
    motion_runs_ = motion_runs_ || starts;
    stop_runs_ = stop_runs_ || step.action == Action::kStopMove;
    recovery_runs_ =
        recovery_runs_ || (step.action == Action::kRecover &&
                           robot.state().robot_mode == RobotMode::kAutomaticErrorRecovery);
  }
  if (step.action == Action::kLock || (step.action == Action::kUnlock && answer == Answer::kDone)) {
    locked_ = step.action == Action::kLock;
  } else if (step.action >= Action::kUserStop && step.action < Action::kSetLoad &&
             step.action != Action::kUnlock) {
    locked_.reset();  // operators' requests may close the brakes
  }
  std::string broken = afterAction(step, answer, before, last, was);
  for (unsigned i = 0; i < step.ticks && broken.empty(); i++) {
    robot.tick();
    broken = afterTick();
  }
  return broken;
}

std::string Invariants::afterAction(const Step& step, Answer answer, const Observation& before,
                                    const RobotState& last, const UnitStatus& was) {
  const Observation now = robot_.observation();
  if (answer == Answer::kIllegalAccepted) {
    return "an illegal value is accepted";
  }
  if (answer == Answer::kRefused && !now.differences(before).empty()) {
    return "a refused request changes: " + now.differences(before);
  }
  if (step.action == Action::kMove && answer == Answer::kDone &&
      (last.robot_mode != RobotMode::kIdle || !was.fci_active || !was.measured)) {
    return "a motion starts where none may start";
  }
  if (step.action == Action::kStopMove && answer == Answer::kDone &&
      last.robot_mode != RobotMode::kMove) {
    return "a stop is accepted without a motion";
  }
  const bool locked =
      last.robot_mode == RobotMode::kUserStopped || last.robot_mode == RobotMode::kOther;
  if (step.action == Action::kRecover && answer == Answer::kDone && locked) {
    return "a recovery is accepted while the user has to act";
  }
  const unsigned allowed = changedBy(step.action);
  for (std::size_t i = 0; i < kPartNames.size(); i++) {
    if ((allowed >> i & 1U) == 0 && !now.isEqual(before, static_cast<Part>(i))) {
      return std::string("a request changes what it does not name: ") + kPartNames[i];
    }
  }
  const bool renewed = robot_.state().message_id < last.message_id;
  if (isSetter(step.action) && !sameMotion(robot_.state(), last)) {
    return "a setter changes the motion";
  }
  // ros_control may clear errors in each mode.
  if (step.action == Action::kRecover && answer == Answer::kDone &&
      robot_.setting().rules != InterfaceRules::kFci) {
    before_.state.errors = robot_.state().errors;
  }
  if (errorCleared() && step.action != Action::kPower) {
    return "an error is cleared without a recovery";
  }
  if (step.action == Action::kRestart || renewed) {
    restarted_ = true;
  }
  stays_idle_ = stays_idle_ && robot_.state().robot_mode == RobotMode::kIdle;
  if (renewed) {
    motion_runs_ = stop_runs_ = recovery_runs_ = false;
    remember();
  }
  const franka_core::ArmLimits& limits = robot_.robot().unit().limits().arm;
  for (std::size_t i = 0; i < 7; i++) {
    limits_.dq[i] = std::max(limits_.dq[i], limits.dq[i]);
    limits_.ddq[i] = std::max(limits_.ddq[i], limits.ddq[i]);
    limits_.dddq[i] = std::max(limits_.dddq[i], limits.dddq[i]);
  }
  return brokenModeRule();
}

bool Invariants::errorCleared() const {
  for (std::size_t i = 0; i < franka_core::kErrorCount; i++) {
    if (before_.state.errors[i] && !robot_.state().errors[i]) {
      return true;
    }
  }
  return false;
}

std::string Invariants::afterTick() {
  const RobotState& state = robot_.state();
  if (robot_.realTimeFaults() > 0) {
    return "a tick or a request allocates or locks";
  }
  if (state.message_id != before_.state.message_id + 1) {
    return "message_id does not advance by one";
  }
  if (errorCleared() && robot_.answers()[2] != Status::kSuccess) {
    return "an error is cleared without a recovery";
  }
  std::string broken = brokenStopRule();
  broken = broken.empty() ? brokenModeRule() : broken;
  broken = broken.empty() ? brokenMotionRule() : broken;
  broken = broken.empty() ? brokenAnswerRule() : broken;
  broken = broken.empty() ? brokenBrakeRule() : broken;
  restarted_ = false;
  actions_ = 0;
  stays_idle_ = state.robot_mode == RobotMode::kIdle;
  remember();
  return broken;
}

// The unit of a robot with power follows the sources in each tick: between two ticks, guiding may
// end by other requests.
std::string Invariants::brokenStopRule() const {
  const SafetyController& safety = robot_.robot().safety();
  if (!safety.state().power) {
    return "";
  }
  const bool panda = !robot_.setting().isFr3();
  // Behind Desk a Panda is guided with its activation device pressed.
  const bool guided = panda && safety.rules() == SafetyRules::kDesk &&
                      robot_.state().robot_mode == RobotMode::kGuiding;
  const bool stop =
      (robot_.stopPressed() && !guided) || (panda && safety.state().conflicting_inputs);
  if (stop != robot_.robot().unit().status().user_stop_pressed) {
    return stop ? "the user stop is not pressed while one of its sources is"
                : "the user stop is pressed while none of its sources is";
  }
  return "";
}

std::string Invariants::brokenModeRule() const {
  const RobotState& state = robot_.state();
  const UnitStatus status = robot_.robot().unit().status();
  const RobotMode mode = state.robot_mode;
  const bool stopped = mode == RobotMode::kUserStopped || mode == RobotMode::kOther;
  if (status.user_stop_pressed && !stopped) {
    return "the user stop is pressed, and the robot is not stopped";
  }
  if (mode == RobotMode::kUserStopped && !status.user_stop_pressed && !status.settling) {
    return "the robot stays stopped without a user stop";
  }
  if (status.brakes_closed && !stopped) {
    return "the brakes are closed in a mode with motors";
  }
  if (anyError(state) && (mode == RobotMode::kIdle || mode == RobotMode::kMove)) {
    return "there is an error in Idle or Move";
  }
  if (mode == RobotMode::kReflex && !anyError(state)) {
    return "there is no error in Reflex";
  }
  const bool moves = mode == RobotMode::kMove;
  if ((state.motion_generator_mode != MotionGeneratorMode::kIdle) != moves ||
      (state.controller_mode != ControllerMode::kOther) != moves) {
    return "generator and controller are active in Move only";
  }
  if (moves && !status.fci_active && !robot_.robot().operatorMotion().active()) {
    return "a client moves the arm without the FCI";
  }
  return "";
}

std::string Invariants::brokenMotionRule() const {
  const RobotState& state = robot_.state();
  const RobotState& last = before_.state;
  const UnitStatus status = robot_.robot().unit().status();
  if (!isFinite(state)) {
    return "the state is not finite";
  }
  const bool moves = state.robot_mode == RobotMode::kMove;
  const bool generates = moves && state.motion_generator_mode != MotionGeneratorMode::kNone &&
                         state.controller_mode != ControllerMode::kExternalController;
  const bool brakes = !moves && last.robot_mode != RobotMode::kMove &&
                      state.robot_mode != RobotMode::kReflex &&
                      state.robot_mode != RobotMode::kAutomaticErrorRecovery &&
                      before_.status.settling && !restarted_;
  const std::array<double, 7>& max_torque = robot_.robot().unit().configuration().max_torque;
  for (std::size_t i = 0; i < 7; i++) {
    const double torque = robot_.arm().torques()[i];
    // The law and the gravity of the configured payload are limited each.
    if (!(std::abs(torque) <= 2.0 * max_torque[i] + 1e-9)) {
      return "a torque is beyond the motors' range";
    }
    if (status.brakes_closed && torque != 0.0) {
      return "there is a torque with closed brakes";
    }
    if (!moves && state.tau_J_d[i] != 0.0) {
      return "tau_J_d is not 0 outside of Move";
    }
    // Clients of protocol 10 compute with 32 bit floats, for which the checks allow.
    if (generates && (std::abs(state.dq_d[i]) > 1.05 * limits_.dq[i] ||
                      std::abs(state.ddq_d[i]) > 1.1 * limits_.ddq[i] + 0.5)) {
      return "the desired motion is beyond the limits";
    }
    if (!moves && std::abs(state.ddq_d[i]) > limits_.ddq[i] * (1.0 + 1e-6)) {
      return "the arm brakes with more than the limit of acceleration";
    }
    const double jerk = std::abs(state.ddq_d[i] - last.ddq_d[i]) / kTick;
    if (brakes && state.dq_d[i] != 0.0 && jerk > limits_.dddq[i] * (1.0 + 1e-6)) {
      return "the arm brakes with more than the limit of jerk";
    }
  }
  if (stays_idle_ && state.robot_mode == RobotMode::kIdle && !before_.status.settling &&
      !restarted_ && before_.status.measured && state.q_d != last.q_d) {
    return "the desired position of an idle arm moves";
  }
  const double width = robot_.hand().width();
  return width > -0.005 && width < 0.085 ? "" : "the fingers leave their range";
}

std::string Invariants::brokenBrakeRule() {
  const SafetyController& safety = robot_.robot().safety();
  const SafetyState& state = safety.state();
  if (safety.rules() != SafetyRules::kDesk || state.self_test || !state.power ||
      state.recoverable[static_cast<std::size_t>(RecoverableError::kTd2Timeout)]) {
    locked_.reset();
  }
  return locked_ && !state.brakes_moving && !robot_.robot().unit().status().settling &&
                 safety.brakesClosed() != *locked_
             ? "the brakes do not follow the last lock or unlock"
             : "";
}

std::string Invariants::brokenAnswerRule() {
  const auto& answers = robot_.answers();
  if (answers[0] && !motion_runs_) {
    return "a motion is answered twice";
  }
  if (answers[2] && !recovery_runs_) {
    return "a recovery is answered twice";
  }
  // Of two requests without a tick between them, the second one may change the mode again.
  const bool ends = actions_ <= 1 && before_.state.robot_mode == RobotMode::kMove;
  if (ends && answers[0] && !isAnswerIn(robot_.state().robot_mode, *answers[0])) {
    return "a motion is answered with the status of another end";
  }
  if (actions_ <= 1 && answers[2] && robot_.state().robot_mode == RobotMode::kUserStopped &&
      answers[2] != Status::kEmergencyAborted) {
    return "a user stop ends a recovery with the status of another end";
  }
  motion_runs_ = motion_runs_ && !answers[0];
  stop_runs_ = stop_runs_ && !answers[1];
  recovery_runs_ = recovery_runs_ && !answers[2];
  const RobotMode mode = robot_.state().robot_mode;
  const bool settled = mode != RobotMode::kMove && !robot_.robot().unit().status().settling;
  if ((settled && (motion_runs_ || stop_runs_)) || (mode == RobotMode::kMove && stop_runs_)) {
    return "a motion or a stop is not answered";
  }
  if (mode != RobotMode::kAutomaticErrorRecovery && recovery_runs_) {
    return "a recovery is not answered";
  }
  return "";
}

}  // namespace franka_sim::test
