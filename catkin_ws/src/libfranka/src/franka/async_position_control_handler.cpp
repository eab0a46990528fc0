// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <franka/async_control/async_position_control_handler.hpp>
#include <random>
#include <stdexcept>

namespace franka {

namespace {

constexpr const char* kStopped =
    "libfranka: This motion has ended; configure a new AsyncPositionControlHandler.";

// A random number in the form of a UUID of version 4.
std::string newUuid() {
  std::random_device random;
  const auto word = [&random] { return static_cast<unsigned>(random()); };
  char text[37];
  std::snprintf(text, sizeof(text), "%08x-%04x-4%03x-%04x-%08x%04x", word(), word() & 0xffff,
                word() & 0xfff, 0x8000 | (word() & 0x3fff), word(), word() & 0xffff);
  return text;
}

}  // namespace

AsyncPositionControlHandler::AsyncPositionControlHandler(std::unique_ptr<ActiveControlBase> motion,
                                                         double goal_tolerance)
    : motion_(std::move(motion)),
      started_at_(motion_->readOnce().first.time),
      goal_tolerance_(goal_tolerance) {}

AsyncPositionControlHandler::~AsyncPositionControlHandler() = default;

AsyncPositionControlHandler::ConfigurationResult AsyncPositionControlHandler::configure(
    const std::shared_ptr<Robot>& robot, const Configuration& configuration) {
  if (!robot) {
    return {nullptr, "libfranka: There is no robot to configure a motion for."};
  }
  if (!std::isfinite(configuration.goal_tolerance) || configuration.goal_tolerance <= 0.0) {
    return {nullptr, "libfranka: The goal tolerance must be greater than 0 rad."};
  }
  try {
    auto motion = robot->startAsyncJointPositionControl(
        research_interface::robot::Move::ControllerMode::kJointImpedance,
        configuration.maximum_joint_velocities);
    return {std::shared_ptr<AsyncPositionControlHandler>(
                new AsyncPositionControlHandler(std::move(motion), configuration.goal_tolerance)),
            std::nullopt};
  } catch (const std::exception& error) {
    return {nullptr, error.what()};
  }
}

AsyncPositionControlHandler::CommandResult AsyncPositionControlHandler::setJointPositionTarget(
    const JointPositionTarget& target) {
  if (!motion_) {
    return {"", false, abort_message_.value_or(kStopped)};
  }
  if (target.joint_positions.size() != 7) {
    return {"", false, "libfranka: A target needs seven joint positions."};
  }
  std::array<double, 7> positions{};
  std::copy_n(target.joint_positions.begin(), 7, positions.begin());
  try {
    // The target answers the newest state, which also shows whether the motion still runs.
    motion_->readOnce();
    motion_->writeOnce(JointPositions(positions));
  } catch (const std::invalid_argument& error) {
    return {"", false, error.what()};
  } catch (const Exception& error) {
    abort(error.what());
    return {"", false, abort_message_};
  }
  target_ = positions;
  return {newUuid(), true, std::nullopt};
}

AsyncPositionControlHandler::TargetFeedback AsyncPositionControlHandler::getTargetFeedback(
    const std::optional<RobotState>& robot_state) {
  if (!motion_) {
    return {TargetStatus::kAborted, abort_message_.value_or(kStopped)};
  }
  try {
    const RobotState state = robot_state ? *robot_state : motion_->readOnce().first;
    if (showsEnd(state)) {
      motion_->readOnce();  // throws with the robot's reason
      throw ControlException("libfranka: The robot does not move any more.");
    }
    if (!target_) {
      return {TargetStatus::kIdle, std::nullopt};
    }
    return {isReached(state) ? TargetStatus::kTargetReached : TargetStatus::kExecuting,
            std::nullopt};
  } catch (const Exception& error) {
    abort(error.what());
    return {TargetStatus::kAborted, abort_message_};
  }
}

void AsyncPositionControlHandler::abort(const char* message) {
  abort_message_ = message;
  motion_.reset();
}

bool AsyncPositionControlHandler::showsEnd(const RobotState& state) const {
  // States from before the motion are not relevant.
  return state.time >= started_at_ && state.robot_mode != RobotMode::kMove;
}

bool AsyncPositionControlHandler::isReached(const RobotState& state) const {
  double distance = 0.0;
  double velocity = 0.0;
  for (std::size_t i = 0; i < 7; i++) {
    distance += std::pow(state.q_d[i] - (*target_)[i], 2);
    velocity += std::pow(state.dq_d[i], 2);
  }
  return std::sqrt(distance) < goal_tolerance_ && std::sqrt(velocity) < kRestVelocity;
}

void AsyncPositionControlHandler::stopControl() { motion_.reset(); }

}  // namespace franka
