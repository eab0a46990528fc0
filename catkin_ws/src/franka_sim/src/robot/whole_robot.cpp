// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/state_codec.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/protocol_range.h>
#include <franka_sim/robot/whole_robot.h>

#include <cstddef>
#include <utility>

namespace franka_sim {

namespace {

// A state's datagram begins with its id (protocol 4.1).
constexpr std::size_t kMessageIdSize = 8;

}  // namespace

WholeRobot::WholeRobot(const ControlUnitParameters& unit, ArmPlant& arm,
                       const std::optional<Hand>& hand,
                       const std::optional<VacuumGripperParameters>& vacuum, unsigned command_delay)
    : unit_(unit),
      arm_(&arm),
      safety_(unit_, unit.protocol_version >= protocolsOf("fr3").oldest),
      operator_motion_(unit_),
      hand_plant_(hand ? hand->plant : nullptr) {
  link_.setDelay(command_delay);
  if (hand) {
    hand_.emplace(hand->parameters);
  }
  if (vacuum) {
    vacuum_.emplace(*vacuum);
  }
}

WholeRobot::WholeRobot(const WholeRobot& other)
    : unit_(other.unit_),
      arm_(other.arm_.get()),
      safety_(unit_, other.safety_.isFr3()),
      operator_motion_(unit_),
      hand_plant_(other.hand_plant_.get()) {
  *this = other;
}

void WholeRobot::halt() noexcept {
  halted_ = !unit_.status().brakes_closed;
  unit_.request(Brakes{true});
}

void WholeRobot::restart() noexcept {
  unit_.restart();
  if (std::exchange(halted_, false)) {
    unit_.request(Brakes{false});
  }
  link_.restart();
  if (hand_) {
    hand_->restart();
  }
  if (vacuum_) {
    vacuum_->restart();
  }
  hashing_ = false;
  hash_ = {};
}

void WholeRobot::renew() {
  unit_ = ControlUnit(unit_.configuration());
  halted_ = false;
  start(safety_.rules());
  restart();
}

void WholeRobot::start(SafetyRules rules) noexcept {
  safety_.start(rules);
  if (hand_ && rules == SafetyRules::kDesk) {
    hand_->invalidateHoming();
  }
}

void WholeRobot::setPower(bool on) {
  if (on == safety_.state().power) {
    return;
  }
  if (on) {
    renew();
    return;
  }
  safety_.switchOff();
  if (hand_) {
    hand_->stop();
  }
}

void WholeRobot::observe() noexcept {
  unit_.observe(arm_->measure());
  if (hand_) {
    // The hand's state is published even while time stands still.
    hand_->observe(hand_plant_->measure());
  }
}

void WholeRobot::actuate(const franka_core::RobotCommand* command) noexcept {
  safety_.step();
  const franka_core::RobotCommand* passed = link_.pass(command);
  hashing_ = hashing_ || passed != nullptr;
  if (operator_motion_.active()) {
    passed = operator_motion_.command();
  }
  if (hashing_) {
    updateHash();
  }
  const std::array<double, 7>& torque = unit_.actuate(passed);
  arm_->setBrakes(unit_.status().brakes_closed);
  arm_->applyTorques(torque);
  if (hand_) {
    hand_plant_->applyForces(hand_->step(hand_plant_->measure(), kTick));
  }
  if (vacuum_) {
    vacuum_->step(kTick);
  }
}

void WholeRobot::updateHash() noexcept {
  franka_core::fci::StateBuffer bytes;
  if (franka_core::fci::encodeState(9, unit_.state(), bytes) ==
      franka_core::fci::CodecError::kNone) {
    hash_.addBytes(bytes.data() + kMessageIdSize, bytes.size() - kMessageIdSize);
  }
}

}  // namespace franka_sim
