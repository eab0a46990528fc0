// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/robot_error.h>
#include <franka_sim/fci/robot_front.h>
#include <franka_sim/fci/serving.h>

#include <array>

namespace franka_sim::fci {

using franka_core::RobotError;

RobotFront::RobotFront(WholeRobot& robot, RobotServerParameters server, const ToolPorts& tools)
    : robot_(robot), handler_(robot.unit()), server_(server, handler_) {
  if (tools.hand) {
    hand_ = std::make_unique<GripperServer>(server.address, *tools.hand, *robot_.hand());
  }
  if (tools.vacuum) {
    vacuum_ = std::make_unique<VacuumServer>(server.address, *tools.vacuum, *robot_.vacuum());
  }
}

void RobotFront::observe() {
  constexpr std::array<RobotError, 3> kCollisions{RobotError::kSelfCollisionAvoidanceViolation,
                                                  RobotError::kJointReflex,
                                                  RobotError::kCartesianReflex};
  const ControlUnit& unit = robot_.unit();
  std::array<bool, kCollisions.size()> before{};
  for (std::size_t i = 0; i < before.size(); i++) {
    before[i] = unit.state().errors[indexOf(kCollisions[i])];
  }
  robot_.observe();
  for (std::size_t i = 0; report_ && i < before.size(); i++) {
    if (!before[i] && unit.state().errors[indexOf(kCollisions[i])]) {
      report_(collisionOf(unit, kCollisions[i]) + " (" +
              franka_core::kErrorNames[indexOf(kCollisions[i])] + ").");
    }
  }
}

const franka_core::RobotCommand* RobotFront::takeCommand() noexcept {
  if (!server_.motionHasBegun()) {
    robot_.link().clear();
  }
  return server_.takeCommand();
}

void RobotFront::actuate() { robot_.actuate(takeCommand()); }

void RobotFront::serve(bool stops_only) {
  server_.serve(stops_only);
  const bool tools = robot_.safety().handServed();
  if (hand_) {
    hand_->setOpen(tools);
    hand_->serve(stops_only);
  }
  if (vacuum_) {
    vacuum_->setOpen(tools);
    vacuum_->serve(stops_only);
  }
}

void RobotFront::publish(std::uint64_t ticks, bool same_moment, bool keep_end) {
  server_.publish(ticks, same_moment, keep_end);
  publishTools(ticks);
}

void RobotFront::publishTools(std::uint64_t ticks) {
  if (hand_) {
    hand_->publish(ticks);
  }
  if (vacuum_) {
    vacuum_->publish(ticks);
  }
}

void RobotFront::repeat() {
  if (server_.asynchronous() || server_.receiveCommand()) {
    server_.repeat();
  }
  publishTools(0);
}

void RobotFront::onRefusal(const ClientSlot::Report& report) {
  server_.onRefusal(report);
  if (hand_) {
    hand_->onRefusal(report);
  }
  if (vacuum_) {
    vacuum_->onRefusal(report);
  }
}

bool RobotFront::hasClients() const {
  return server_.hasClient() || (hand_ && hand_->hasClient()) || (vacuum_ && vacuum_->hasClient());
}

bool RobotFront::idle() const {
  return server_.idle() && (!hand_ || hand_->idle()) && (!vacuum_ || vacuum_->idle());
}

bool RobotFront::settling() const {
  const franka_core::RobotState& state = robot_.unit().state();
  if (state.robot_mode == franka_core::RobotMode::kGuiding) {
    return false;  // nothing brakes an arm in Guiding: it may never come to rest
  }
  const bool abandoned =
      state.robot_mode == franka_core::RobotMode::kMove && !server_.expectsCommands();
  const UnitStatus status = robot_.unit().status();
  return status.settling || abandoned || !status.resting || robot_.safety().busy();
}

bool RobotFront::handBusy() const {
  return (hand_ && hand_->busy()) || (vacuum_ && vacuum_->busy());
}

void RobotFront::addDescriptors(std::vector<pollfd>& fds) const {
  server_.addDescriptors(fds);
  if (hand_) {
    hand_->addDescriptors(fds);
  }
  if (vacuum_) {
    vacuum_->addDescriptors(fds);
  }
}

}  // namespace franka_sim::fci
