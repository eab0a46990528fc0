// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/robot_error.h>
#include <franka_sim/fci/serving.h>
#include <franka_sim/fci/sim_robot.h>
#include <franka_sim/robot/tick.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace franka_sim::fci {

using franka_core::RobotError;

namespace {

std::string addressOf(const RobotServerParameters& parameters) { return parameters.address; }

}  // namespace

SimRobot::SimRobot(const ControlUnitParameters& unit, ArmPlant& arm, RobotServerParameters server,
                   const std::optional<Hand>& hand, const std::optional<Vacuum>& vacuum,
                   unsigned command_delay)
    : unit_(unit), arm_(arm), handler_(unit_), server_(server, handler_) {
  link_.setDelay(command_delay);
  if (hand) {
    hand_ = std::make_unique<ServedHand>(addressOf(server), *hand);
  }
  if (vacuum) {
    vacuum_ = std::make_unique<ServedVacuum>(addressOf(server), *vacuum);
  }
}

void SimRobot::halt() noexcept {
  halted_ = !unit_.status().brakes_closed;
  unit_.request(Brakes{true});
}

void SimRobot::restart() noexcept {
  unit_.restart();
  if (std::exchange(halted_, false)) {
    unit_.request(Brakes{false});
  }
  link_.restart();
  if (hand_) {
    hand_->unit.restart();
  }
  if (vacuum_) {
    vacuum_->unit.restart();
  }
  hashing_ = false;
  hash_ = {};
}

void SimRobot::observe() {
  constexpr std::array<RobotError, 3> kCollisions{RobotError::kSelfCollisionAvoidanceViolation,
                                                  RobotError::kJointReflex,
                                                  RobotError::kCartesianReflex};
  std::array<bool, kCollisions.size()> before{};
  for (std::size_t i = 0; i < before.size(); i++) {
    before[i] = unit_.state().errors[indexOf(kCollisions[i])];
  }
  unit_.observe(arm_.measure());
  if (hand_) {
    // The hand's state is sent even while time stands still.
    hand_->unit.observe(hand_->plant.measure());
  }
  for (std::size_t i = 0; tell_ && i < before.size(); i++) {
    if (!before[i] && unit_.state().errors[indexOf(kCollisions[i])]) {
      tell_(collisionOf(unit_, kCollisions[i]) + " (" +
            franka_core::kErrorNames[indexOf(kCollisions[i])] + ").");
    }
  }
}

void SimRobot::actuate() {
  if (!server_.motionHasBegun()) {
    link_.clear();  // removes commands of another motion
  }
  const franka_core::RobotCommand* command = link_.pass(server_.takeCommand());
  hashing_ = hashing_ || command != nullptr;
  if (hashing_) {
    updateHash();
  }
  const std::array<double, 7>& torque = unit_.actuate(command);
  arm_.setBrakes(unit_.status().brakes_closed);
  arm_.applyTorques(torque);
  if (hand_) {
    hand_->plant.applyForces(hand_->unit.step(hand_->plant.measure(), kTick));
  }
  if (vacuum_) {
    vacuum_->unit.step(kTick);
  }
}

void SimRobot::updateHash() noexcept {
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

void SimRobot::serve(bool stops_only) {
  server_.serve(stops_only);
  if (hand_) {
    hand_->server.serve(stops_only);
  }
  if (vacuum_) {
    vacuum_->server.serve(stops_only);
  }
}

void SimRobot::publish(std::uint64_t ticks, bool same_moment) {
  server_.publish(ticks, same_moment);
  publishTools(ticks);
}

void SimRobot::publishTools(std::uint64_t ticks) {
  if (hand_) {
    hand_->server.publish(ticks);
  }
  if (vacuum_) {
    vacuum_->server.publish(ticks);
  }
}

void SimRobot::repeat() {
  if (server_.asynchronous() || server_.receiveCommand()) {
    server_.repeat();
  }
  publishTools(0);
}

void SimRobot::onRefusal(const ClientSlot::Tell& tell) {
  server_.onRefusal(tell);
  if (hand_) {
    hand_->server.onRefusal(tell);
  }
  if (vacuum_) {
    vacuum_->server.onRefusal(tell);
  }
}

bool SimRobot::hasClients() const {
  return server_.hasClient() || (hand_ && hand_->server.hasClient()) ||
         (vacuum_ && vacuum_->server.hasClient());
}

bool SimRobot::settling() const {
  const franka_core::RobotState& state = unit_.state();
  if (state.robot_mode == franka_core::RobotMode::kGuiding) {
    return false;  // nothing brakes an arm in Guiding: it may never come to rest
  }
  const bool abandoned =
      state.robot_mode == franka_core::RobotMode::kMove && !server_.expectsCommands();
  const UnitStatus status = unit_.status();
  return status.settling || abandoned || !status.resting;
}

bool SimRobot::handBusy() const {
  return (hand_ && hand_->server.busy()) || (vacuum_ && vacuum_->server.busy());
}

void SimRobot::addDescriptors(std::vector<pollfd>& fds) const {
  server_.addDescriptors(fds);
  if (hand_) {
    hand_->server.addDescriptors(fds);
  }
  if (vacuum_) {
    vacuum_->server.addDescriptors(fds);
  }
}

}  // namespace franka_sim::fci
