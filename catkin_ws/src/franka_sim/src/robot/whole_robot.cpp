// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/state_codec.h>
#include <franka_sim/robot/tick.h>
#include <franka_sim/robot/whole_robot.h>

#include <cstring>
#include <utility>

namespace franka_sim {

namespace {

// Force laws of the fingers: gains of the original's FrankaGripperSim (decision 29).
constexpr FingerGains kFingerGains{100.0, 0.0, 1.0};

constexpr unsigned kOldestFr3Version = 6;

}  // namespace

WholeRobot::WholeRobot(const ControlUnitParameters& unit, ArmPlant& arm,
                       const std::optional<Hand>& hand,
                       const std::optional<VacuumGripperParameters>& vacuum, unsigned command_delay)
    : unit_(unit),
      arm_(arm),
      safety_(unit_, unit.protocol_version >= kOldestFr3Version),
      operator_motion_(unit_) {
  link_.setDelay(command_delay);
  if (hand) {
    hand_plant_ = hand->plant;
    hand_.emplace(hand->parameters);
  }
  if (vacuum) {
    vacuum_.emplace(*vacuum);
  }
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
    hand_->forgetHoming();
  }
}

void WholeRobot::setPower(bool on) {
  const bool starts = on && !safety_.state().power;
  safety_.setPower(on);
  if (starts) {
    renew();
  } else if (!on && hand_) {
    hand_->stop();
  }
}

void WholeRobot::observe() noexcept {
  unit_.observe(arm_.measure());
  if (hand_) {
    // The hand's state is shown even while time stands still.
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
  arm_.setBrakes(unit_.status().brakes_closed);
  arm_.applyTorques(torque);
  if (hand_) {
    hand_plant_->applyForces(hand_->step(hand_plant_->measure(), kTick));
  }
  if (vacuum_) {
    vacuum_->step(kTick);
  }
}

void WholeRobot::updateHash() noexcept {
  franka_core::RobotState state = unit_.state();
  state.message_id = 0;
  franka_core::fci::StateBuffer bytes;
  if (franka_core::fci::encodeState(9, state, bytes) != franka_core::fci::CodecError::kNone) {
    return;
  }
  // Eight bytes at a time; the remaining bytes one by one.
  std::size_t i = 0;
  for (; i + sizeof(std::uint64_t) <= bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word;
    std::memcpy(&word, &bytes[i], sizeof(word));
    hash_.addWord(word, 32);
  }
  for (; i < bytes.size(); i++) {
    hash_.addByte(bytes[i]);
  }
}

GripperParameters handParameters(const GripperLatency& latency) {
  GripperParameters parameters;
  parameters.gains = {kFingerGains, kFingerGains};
  parameters.latency = latency;
  return parameters;
}

}  // namespace franka_sim
