// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/safety/safety_controller.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace franka_sim {

using franka_core::RobotMode;

namespace {

constexpr double kSelfTestPeriod = 86400.0;  // [s] (decision 54)

// Translations, rotations and elbow that the operator may move.
std::array<bool, 7> axesOf(GuidingMode mode, const std::array<bool, 7>& chosen) noexcept {
  switch (mode) {
    case GuidingMode::kTranslation:
      return {true, true, true, false, false, false, false};
    case GuidingMode::kRotation:
      return {false, false, false, true, true, true, false};
    case GuidingMode::kUser:
      return chosen;
    default:
      return {true, true, true, true, true, true, true};
  }
}

bool any(const std::array<bool, 7>& joints) noexcept {
  return std::any_of(joints.begin(), joints.end(), [](bool joint) { return joint; });
}

}  // namespace

// --- start and power -----------------------------------------------------------------------------

void SafetyController::start(SafetyRules rules) noexcept {
  SafetyState started;
  if (!state_.power) {
    started.inputs = state_.inputs;
    started.inputs[static_cast<std::size_t>(SafetyInput::kGuidingButton)] = false;
    started.user_stop = state_.user_stop;
  }
  rules_ = rules;
  state_ = started;
  moveBrakes(BrakeMotion::kNone);
  applyStops();
  unit_->request(FciActivation{!hasDeskRules()});
  unit_->request(Brakes{hasDeskRules()});
  state_.brakes_closed.fill(hasDeskRules());
}

void SafetyController::switchOff() noexcept {
  deactivateFci();
  unit_->request(Guiding{false});
  unit_->request(Brakes{true});
  state_.brakes_closed.fill(true);
  moveBrakes(BrakeMotion::kNone);
  state_.self_test = false;
  state_.power = false;
}

// --- brakes --------------------------------------------------------------------------------------

Refusal SafetyController::refusalOfMotors() const noexcept {
  if (!state_.power) {
    return Refusal::kNotReady;
  }
  if (state_.self_test) {
    return Refusal::kSelfTestRunning;
  }
  if (!hasDeskRules()) {
    return Refusal::kNone;
  }
  if (anyRecoverable()) {
    return Refusal::kRecoverableErrorActive;
  }
  if (any(state_.demanded[0]) || any(state_.demanded[1])) {
    return Refusal::kJointRecoveryRequired;
  }
  return fr3_ && pressed(SafetyInput::kX31) ? Refusal::kEmergencyStopPressed : Refusal::kNone;
}

void SafetyController::moveBrakes(BrakeMotion motion) noexcept {
  brakes_ = motion;
  since_ = 0.0;
  state_.brakes_moving = motion != BrakeMotion::kNone;
}

Refusal SafetyController::unlock() noexcept {
  const Refusal refusal = refusalOfMotors();
  if (refusal != Refusal::kNone) {
    return refusal;
  }
  if (!hasDeskRules()) {
    unit_->request(Brakes{false});
  } else if (brakes_ == BrakeMotion::kClosing ||
             (brakesClosed() && brakes_ == BrakeMotion::kNone)) {
    moveBrakes(BrakeMotion::kOpening);
  }
  return Refusal::kNone;
}

void SafetyController::lock() noexcept {
  if (hasDeskRules()) {
    deactivateFci();
  }
  before_self_test_.brakes_closed = true;
  closeBrakes();
}

// The motors bring the arm to rest before the unit closes its brakes.
void SafetyController::closeBrakes() noexcept {
  unit_->request(Brakes{true});
  const bool all = std::all_of(state_.brakes_closed.begin(), state_.brakes_closed.end(),
                               [](bool closed) { return closed; });
  const bool must_move =
      brakes_ == BrakeMotion::kOpening || (!all && brakes_ == BrakeMotion::kNone);
  if (hasDeskRules() && must_move) {
    moveBrakes(BrakeMotion::kClosing);
  }
}

void SafetyController::advanceBrakes() noexcept {
  if (brakes_ == BrakeMotion::kNone) {
    return;
  }
  const bool closing = brakes_ == BrakeMotion::kClosing;
  if (closing && !unit_->status().brakes_closed) {
    return;  // the arm still brakes
  }
  since_ += kTick;
  const double joints = static_cast<double>(state_.brakes_closed.size());
  const double share = brake_time_ > 0.0 ? since_ / brake_time_ : 1.0;
  const auto moved = static_cast<std::size_t>(std::min(joints, share * joints));
  std::fill_n(state_.brakes_closed.begin(), moved, closing);
  if (moved < state_.brakes_closed.size()) {
    return;
  }
  moveBrakes(BrakeMotion::kNone);
  if (!closing) {
    unit_->request(Brakes{false});
  }
}

bool SafetyController::brakesClosed() const noexcept { return any(state_.brakes_closed); }

// --- FCI and operating mode ----------------------------------------------------------------------

Refusal SafetyController::activateFci() noexcept {
  Refusal refusal = refusalOfMotors();
  if (hasDeskRules() && refusal == Refusal::kNone) {
    if (brakesClosed()) {
      refusal = Refusal::kBrakesClosed;
    } else if (state_.mode != OperatingMode::kExecution) {
      refusal = Refusal::kWrongOperatingMode;
    } else if (stopPressed()) {
      refusal = Refusal::kEmergencyStopPressed;
    } else if (!fciActive() && unit_->state().robot_mode == RobotMode::kMove) {
      refusal = Refusal::kMotionActive;
    }
  }
  if (refusal == Refusal::kNone) {
    unit_->request(FciActivation{true});
  }
  return refusal;
}

void SafetyController::deactivateFci() noexcept {
  before_self_test_.fci_active = false;
  unit_->request(FciActivation{false});
}

Refusal SafetyController::setOperatingMode(OperatingMode mode) noexcept {
  if (mode == state_.mode) {
    return state_.power ? Refusal::kNone : Refusal::kNotReady;
  }
  if (const Refusal refusal = refusalOfMotors(); refusal != Refusal::kNone) {
    return refusal;
  }
  if (mode == OperatingMode::kProgramming) {
    deactivateFci();
  } else {
    guide(false);
  }
  state_.mode = mode;
  return Refusal::kNone;
}

Refusal SafetyController::allowsOperatorMotion() const noexcept {
  const Refusal refusal = refusalOfMotors();
  if (refusal != Refusal::kNone) {
    return refusal;
  }
  if (brakesClosed()) {
    return Refusal::kBrakesClosed;
  }
  if (stopPressed()) {
    return Refusal::kEmergencyStopPressed;
  }
  const bool client = hasDeskRules() && fciActive();  // the FCI has exclusive control of the arm
  return client || unit_->state().robot_mode == RobotMode::kMove ? Refusal::kMotionActive
                                                                 : Refusal::kNone;
}

bool SafetyController::handServed() const noexcept {
  return state_.power && state_.end_effector_power && (!hasDeskRules() || fciActive());
}

// --- inputs --------------------------------------------------------------------------------------

void SafetyController::press(SafetyInput input, bool pressed) noexcept {
  if (input == SafetyInput::kGuidingButton) {
    guide(pressed);
    return;
  }
  state_.inputs[static_cast<std::size_t>(input)] = pressed;
  inputChanges(input, pressed);
}

void SafetyController::pressUserStop(bool pressed) noexcept {
  state_.user_stop = pressed;
  inputChanges(userStopInput(), pressed);
}

void SafetyController::inputChanges(SafetyInput input, bool pressed) noexcept {
  if (!fr3_ && input == SafetyInput::kX4 && pressed) {
    state_.conflicting_inputs = false;  // its next release activates the robot again
  }
  if (guidesWithStop() && !stopPressed()) {
    guide(false);
  }
  applyStops();
  if (fr3_ && hasDeskRules() && input == SafetyInput::kX31 && pressed) {
    lock();
  }
}

bool SafetyController::pressed(SafetyInput input) const noexcept {
  return state_.inputs[static_cast<std::size_t>(input)] ||
         (state_.user_stop && input == userStopInput());
}

bool SafetyController::stopPressed() const noexcept {
  for (std::size_t i = 0; i < kSafetyInputCount; i++) {
    const auto input = static_cast<SafetyInput>(i);
    if (isStop(input) && pressed(input)) {
      return true;
    }
  }
  return false;
}

bool SafetyController::isStop(SafetyInput input) const noexcept {
  return fr3_ ? input == SafetyInput::kX31 || input == SafetyInput::kX32 ||
                    input == SafetyInput::kX33
              : input == SafetyInput::kX4;
}

// Behind Desk a Panda is guided while its activation device is pressed; the unit cannot guide while
// it is stopped.
bool SafetyController::guidesWithStop() const noexcept {
  return !fr3_ && hasDeskRules() && unit_->state().robot_mode == RobotMode::kGuiding;
}

// The unit's user stop follows its sources; in each tick, too, because guiding also ends without
// the operator.
void SafetyController::applyStops() noexcept {
  const bool stop = (stopPressed() && !guidesWithStop()) || (!fr3_ && state_.conflicting_inputs);
  if (stop != unit_->status().user_stop_pressed) {
    unit_->request(UserStop{stop});
  }
}

Refusal SafetyController::guide(bool active) noexcept {
  bool& button = state_.inputs[static_cast<std::size_t>(SafetyInput::kGuidingButton)];
  const bool was_pressed = std::exchange(button, active);
  if (!active) {
    state_.conflicting_inputs = state_.conflicting_inputs && !fr3_;
    unit_->request(Guiding{false});
    applyStops();
    return Refusal::kNone;
  }
  Refusal refusal = refusalOfMotors();
  if (hasDeskRules() && refusal == Refusal::kNone) {
    const bool allowed = fr3_ ? state_.mode == OperatingMode::kProgramming && !stopPressed()
                              : pressed(SafetyInput::kX4);
    if (brakesClosed()) {
      refusal = Refusal::kBrakesClosed;
    } else if (!allowed) {
      state_.conflicting_inputs = true;
      refusal = Refusal::kWrongOperatingMode;
    } else {
      unit_->request(UserStop{false});
    }
  }
  if (refusal == Refusal::kNone) {
    unit_->request(Guiding{true});
    refusal = refusalOfGuiding();
  }
  if (!hasDeskRules() && refusal != Refusal::kNone) {
    button = was_pressed;
  }
  applyStops();
  return refusal;
}

// Why the unit is not guided after the request.
Refusal SafetyController::refusalOfGuiding() const noexcept {
  switch (unit_->state().robot_mode) {
    case RobotMode::kGuiding:
      return Refusal::kNone;
    case RobotMode::kUserStopped:  // behind Desk, an arm that still brakes for a stop
      return hasDeskRules() ? Refusal::kMotionActive : Refusal::kEmergencyStopPressed;
    case RobotMode::kOther:
      return Refusal::kBrakesClosed;
    default:
      return Refusal::kMotionActive;
  }
}

Refusal SafetyController::setGuidingMode(GuidingMode mode,
                                         const std::array<bool, 7>& axes) noexcept {
  const std::array<bool, 7> free = axesOf(mode, axes);
  franka_core::fci::SetGuidingModeRequest request;
  std::copy_n(free.begin(), request.guiding_mode.size(), request.guiding_mode.begin());
  request.nullspace = free.back();
  if (unit_->request(request) != Status::kSuccess) {
    return Refusal::kMotionActive;
  }
  state_.guiding_mode = mode;
  state_.guiding_axes = free;
  return Refusal::kNone;
}

// --- self-test and errors ------------------------------------------------------------------------

Refusal SafetyController::startSelfTest() noexcept {
  const Refusal refusal = refusalOfMotors();
  if (refusal != Refusal::kNone) {
    return refusal;
  }
  const BeforeSelfTest before{unit_->status().close_brakes, fciActive()};
  guide(false);
  deactivateFci();
  unit_->request(Brakes{true});
  moveBrakes(BrakeMotion::kNone);
  state_.brakes_closed.fill(true);
  before_self_test_ = before;
  state_.self_test = true;
  state_.self_test_left = self_test_time_;
  return Refusal::kNone;
}

void SafetyController::advanceSelfTest() noexcept {
  state_.self_test_left -= kTick;
  if (state_.self_test_left > 0.0) {
    return;
  }
  state_.self_test = false;
  state_.self_test_left = 0.0;
  state_.self_test_due = kSelfTestPeriod;
  if (!hasDeskRules()) {
    unit_->request(Brakes{before_self_test_.brakes_closed});
    unit_->request(FciActivation{before_self_test_.fci_active});
  }
}

void SafetyController::setSelfTestDue(double due) noexcept {
  state_.self_test_due = std::max(due, kTick);
}

void SafetyController::advanceClock() noexcept {
  const double before = state_.self_test_due;
  state_.self_test_due = std::max(0.0, before - kTick);
  if (hasDeskRules() && before > 0.0 && state_.self_test_due == 0.0) {
    inject(RecoverableError::kTd2Timeout, true);
  }
}

Refusal SafetyController::acknowledge(RecoverableError error) noexcept {
  bool& active = state_.recoverable[static_cast<std::size_t>(error)];
  if (!active) {
    return Refusal::kNoAckRequired;
  }
  active = false;
  return Refusal::kNone;
}

Refusal SafetyController::acknowledge(DemandedRecovery recovery) noexcept {
  std::array<bool, 7>& joints = state_.demanded[static_cast<std::size_t>(recovery)];
  if (!any(joints)) {
    return Refusal::kNoAckRequired;
  }
  if (!pressed(SafetyInput::kX4)) {
    return Refusal::kJointRecoveryRequired;
  }
  joints.fill(false);
  return Refusal::kNone;
}

void SafetyController::inject(RecoverableError error, bool active) noexcept {
  state_.recoverable[static_cast<std::size_t>(error)] = active;
  if (active && hasDeskRules()) {
    lock();
  }
}

void SafetyController::inject(DemandedRecovery recovery, std::size_t joint, bool active) noexcept {
  state_.demanded[static_cast<std::size_t>(recovery)][joint] = active;
  if (active && hasDeskRules()) {
    lock();
  }
}

bool SafetyController::anyRecoverable() const noexcept {
  return std::any_of(state_.recoverable.begin(), state_.recoverable.end(),
                     [](bool error) { return error; });
}

// --- a tick --------------------------------------------------------------------------------------

void SafetyController::step() noexcept {
  if (!state_.power) {
    return;
  }
  if (state_.self_test) {
    advanceSelfTest();
  } else {
    advanceClock();
    advanceBrakes();
  }
  applyStops();
  if (!hasDeskRules()) {
    state_.brakes_closed.fill(unit_->status().brakes_closed);
  }
}

Light SafetyController::light() const noexcept {
  const RobotMode mode = unit_->state().robot_mode;
  const bool failed = anyRecoverable() || any(state_.demanded[0]) || any(state_.demanded[1]) ||
                      mode == RobotMode::kReflex || mode == RobotMode::kAutomaticErrorRecovery;
  if (!state_.power || state_.self_test) {
    return {LightColor::kYellow, true};
  }
  if (failed) {
    return {LightColor::kRed};
  }
  if (brakesClosed()) {
    return {LightColor::kYellow, state_.brakes_moving};
  }
  if (state_.conflicting_inputs) {
    return {LightColor::kPink};
  }
  if (fr3_ && stopPressed()) {
    return {LightColor::kYellow};
  }
  if (fr3_ ? state_.mode == OperatingMode::kProgramming : stopPressed()) {
    return {LightColor::kWhite};
  }
  const bool green = mode == RobotMode::kMove || (fr3_ && fciActive());
  return {green ? LightColor::kGreen : LightColor::kBlue};
}

}  // namespace franka_sim
