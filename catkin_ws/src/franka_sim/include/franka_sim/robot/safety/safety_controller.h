// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/fixed_pointer.h>
#include <franka_sim/robot/safety/refusal.h>
#include <franka_sim/robot/safety/safety_state.h>

#include <array>
#include <cstddef>

namespace franka_sim {

/// The rules that decide whether clients may connect and the arm may move.
enum class SafetyRules {
  /// Each request is executed at once: a robot that is always ready.
  kOpen,
  /// As with a real robot and its Desk: brakes open joint by joint, requests that the state does
  /// not allow are refused, stops and errors lock the arm, the self-test is due once a day.
  kDesk,
};

/// The safety controller of one robot: brakes, stops, operating mode, self-test and errors that the
/// operator acknowledges. It sends requests to the control unit; the operator's requests come here.
/// It alone presses and releases the unit's user stop: the unit is stopped while any source is
/// pressed, by whichever interface it was pressed (decision 54).
///
/// The rules are listed in the decisions (decision 54). Called by one thread, between two ticks.
/// Real-time safe.
class SafetyController {
 public:
  /// @param unit outlives the controller. @param fr3 an FR3, otherwise a Panda
  SafetyController(ControlUnit& unit, bool fr3) noexcept : unit_(&unit), fr3_(fr3) {}

  /// The condition after power-up: brakes closed, FCI inactive, no errors. With kOpen: ready. Stops
  /// that were pressed while the robot was off still are.
  void start(SafetyRules rules) noexcept;
  /// Call at each tick, before the unit's `actuate`.
  void step() noexcept;

  // Idempotent. Refused requests change nothing.

  /// Opens the brakes joint by joint; ends when `state().brakes_moving` becomes false.
  Refusal unlock() noexcept;
  /// Ends a motion, with Desk's rules also the FCI, then closes the brakes. Never refused: they
  /// stay closed after a self-test that runs.
  void lock() noexcept;
  Refusal activateFci() noexcept;
  /// A running motion ends (kAborted), and clients are disconnected. Never refused, as lock().
  void deactivateFci() noexcept;
  /// FR3 only. Programming ends the FCI.
  Refusal setOperatingMode(OperatingMode mode) noexcept;
  void press(SafetyInput input, bool pressed) noexcept;
  void press(std::size_t button, bool pressed) noexcept { state_.buttons[button] = pressed; }
  /// Presses the operator's stop, which acts as a device at X3.1 of an FR3 and at X4 of a Panda.
  void pressUserStop(bool pressed) noexcept;
  /// Presses the guiding button. @returns why the arm does not become free, kNone if it does
  Refusal guide(bool active) noexcept;
  /// @param axes x, y, z, turns about them, elbow: only for GuidingMode::kUser
  Refusal setGuidingMode(GuidingMode mode, const std::array<bool, 7>& axes) noexcept;
  void setArrowsGuideDesk(bool desk) noexcept { state_.arrows_guide_desk = desk; }
  /// Closes the brakes and tests; ends when `state().self_test` becomes false. With kOpen, brakes
  /// and FCI are then as before.
  Refusal startSelfTest() noexcept;
  /// @param due [s] until the self-test is overdue; 0: from the next tick on
  void setSelfTestDue(double due) noexcept;
  Refusal acknowledge(RecoverableError error) noexcept;
  /// Only while the enabling device is pressed.
  Refusal acknowledge(DemandedRecovery recovery) noexcept;
  void inject(RecoverableError error, bool active) noexcept;
  void inject(DemandedRecovery recovery, std::size_t joint, bool active) noexcept;
  void setEndEffectorPower(bool on) noexcept { state_.end_effector_power = on; }
  /// No client can connect, and no request is accepted until `start`.
  void switchOff() noexcept;
  /// Whether the operator may move the arm by Desk now.
  Refusal allowsOperatorMotion() const noexcept;

  /// Durations [s]: of opening or closing all brakes, and of the self-test.
  void setBrakeTime(double seconds) noexcept { brake_time_ = seconds; }
  void setSelfTestTime(double seconds) noexcept { self_test_time_ = seconds; }

  const SafetyState& state() const noexcept { return state_; }
  SafetyRules rules() const noexcept { return rules_; }
  bool isFr3() const noexcept { return fr3_; }
  Light light() const noexcept;
  bool brakesClosed() const noexcept;
  /// Whether an input is pressed: at its connector, or X3.1 or X4 by the operator's stop.
  bool pressed(SafetyInput input) const noexcept;
  /// Whether an input is a source of the robot's user stop.
  bool isStop(SafetyInput input) const noexcept;
  /// Whether any of these is pressed.
  bool stopPressed() const noexcept;
  bool fciActive() const noexcept { return unit_->status().fci_active; }
  /// Whether clients of the hand may connect.
  bool handServed() const noexcept;
  /// Whether time must advance: brakes move, or the self-test runs.
  bool busy() const noexcept { return state_.brakes_moving || state_.self_test; }

 private:
  enum class BrakeMotion { kNone, kOpening, kClosing };

  /// What the self-test found, and restores with kOpen.
  struct BeforeSelfTest {
    bool brakes_closed{false}, fci_active{false};
  };

  bool hasDeskRules() const noexcept { return rules_ == SafetyRules::kDesk; }
  SafetyInput userStopInput() const noexcept { return fr3_ ? SafetyInput::kX31 : SafetyInput::kX4; }
  bool anyRecoverable() const noexcept;
  Refusal refusalOfMotors() const noexcept;
  void moveBrakes(BrakeMotion motion) noexcept;
  void closeBrakes() noexcept;
  void advanceBrakes() noexcept;
  void advanceSelfTest() noexcept;
  void advanceClock() noexcept;
  void inputChanges(SafetyInput input, bool pressed) noexcept;
  void applyStops() noexcept;
  bool guidesWithStop() const noexcept;
  Refusal refusalOfGuiding() const noexcept;

  FixedPointer<ControlUnit> unit_;
  bool fr3_;
  SafetyRules rules_{SafetyRules::kOpen};
  SafetyState state_;
  BeforeSelfTest before_self_test_;
  BrakeMotion brakes_{BrakeMotion::kNone};
  double brake_time_{5.0};      // [s] (decision 54)
  double self_test_time_{8.0};  // [s] (decision 54)
  double since_{0.0};           // the brakes' motion began [s]
};

}  // namespace franka_sim
