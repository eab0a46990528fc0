// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/robot_error.h>
#include <franka_sim/fci/serving.h>
#include <franka_sim/fci/sim_robot.h>

#include <algorithm>
#include <utility>

namespace franka_sim::fci {

using franka_core::RobotError;

namespace {

std::string addressOf(const RobotServerParameters& parameters) { return parameters.address; }

std::optional<WholeRobot::Hand> unitOf(const std::optional<SimRobot::Hand>& hand) {
  return hand ? std::optional<WholeRobot::Hand>({hand->plant, hand->parameters}) : std::nullopt;
}

std::optional<VacuumGripperParameters> unitOf(const std::optional<SimRobot::Vacuum>& vacuum) {
  return vacuum ? std::optional(vacuum->parameters) : std::nullopt;
}

}  // namespace

SimRobot::SimRobot(const ControlUnitParameters& unit, ArmPlant& arm, RobotServerParameters server,
                   const std::optional<Hand>& hand, const std::optional<Vacuum>& vacuum,
                   unsigned command_delay)
    : robot_(unit, arm, unitOf(hand), unitOf(vacuum), command_delay),
      handler_(robot_.unit()),
      server_(server, handler_) {
  if (hand) {
    hand_ = std::make_unique<GripperServer>(addressOf(server), hand->port, *robot_.hand());
  }
  if (vacuum) {
    vacuum_ = std::make_unique<VacuumServer>(addressOf(server), vacuum->port, *robot_.vacuum());
  }
}

void SimRobot::observe() {
  constexpr std::array<RobotError, 3> kCollisions{RobotError::kSelfCollisionAvoidanceViolation,
                                                  RobotError::kJointReflex,
                                                  RobotError::kCartesianReflex};
  const ControlUnit& unit = robot_.unit();
  std::array<bool, kCollisions.size()> before{};
  for (std::size_t i = 0; i < before.size(); i++) {
    before[i] = unit.state().errors[indexOf(kCollisions[i])];
  }
  robot_.observe();
  for (std::size_t i = 0; tell_ && i < before.size(); i++) {
    if (!before[i] && unit.state().errors[indexOf(kCollisions[i])]) {
      tell_(collisionOf(unit, kCollisions[i]) + " (" +
            franka_core::kErrorNames[indexOf(kCollisions[i])] + ").");
    }
  }
}

void SimRobot::actuate() {
  if (!server_.motionHasBegun()) {
    robot_.link().clear();  // removes commands of another motion
  }
  robot_.actuate(server_.takeCommand());
}

void SimRobot::serve(bool stops_only) {
  server_.serve(stops_only);
  if (hand_) {
    hand_->serve(stops_only);
  }
  if (vacuum_) {
    vacuum_->serve(stops_only);
  }
}

void SimRobot::publish(std::uint64_t ticks, bool same_moment) {
  server_.publish(ticks, same_moment);
  publishTools(ticks);
}

void SimRobot::publishTools(std::uint64_t ticks) {
  if (hand_) {
    hand_->publish(ticks);
  }
  if (vacuum_) {
    vacuum_->publish(ticks);
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
    hand_->onRefusal(tell);
  }
  if (vacuum_) {
    vacuum_->onRefusal(tell);
  }
}

bool SimRobot::hasClients() const {
  return server_.hasClient() || (hand_ && hand_->hasClient()) || (vacuum_ && vacuum_->hasClient());
}

bool SimRobot::settling() const {
  const franka_core::RobotState& state = robot_.unit().state();
  if (state.robot_mode == franka_core::RobotMode::kGuiding) {
    return false;  // nothing brakes an arm in Guiding: it may never come to rest
  }
  const bool abandoned =
      state.robot_mode == franka_core::RobotMode::kMove && !server_.expectsCommands();
  const UnitStatus status = robot_.unit().status();
  return status.settling || abandoned || !status.resting;
}

bool SimRobot::handBusy() const { return (hand_ && hand_->busy()) || (vacuum_ && vacuum_->busy()); }

void SimRobot::addDescriptors(std::vector<pollfd>& fds) const {
  server_.addDescriptors(fds);
  if (hand_) {
    hand_->addDescriptors(fds);
  }
  if (vacuum_) {
    vacuum_->addDescriptors(fds);
  }
}

}  // namespace franka_sim::fci
