// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/active_motion_generator.h>
#include <franka/active_torque_control.h>
#include <franka/exception.h>
#include <franka_core/to_franka.h>

#include <optional>

#include "franka/active_control_motion.h"
#include "franka/command_shaping.h"

namespace franka {

namespace {

constexpr const char* kEnded =
    "libfranka: This motion has ended; start another one with Robot::start...Control.";
constexpr const char* kWrongForm =
    "libfranka: This form of writeOnce does not belong to the motion that was started.";

}  // namespace

ActiveControl::ActiveControl(std::unique_ptr<Motion> motion) : motion_(std::move(motion)) {}

ActiveControl::~ActiveControl() = default;

std::pair<RobotState, Duration> ActiveControl::readOnce() { return motion_->read(); }

void ActiveControl::writeOnce(const Torques&) { throw ControlException(kWrongForm); }
void ActiveControl::writeOnce(const JointPositions&, const std::optional<const Torques>&) {
  throw ControlException(kWrongForm);
}
void ActiveControl::writeOnce(const JointVelocities&, const std::optional<const Torques>&) {
  throw ControlException(kWrongForm);
}
void ActiveControl::writeOnce(const CartesianPose&, const std::optional<const Torques>&) {
  throw ControlException(kWrongForm);
}
void ActiveControl::writeOnce(const CartesianVelocities&, const std::optional<const Torques>&) {
  throw ControlException(kWrongForm);
}
void ActiveControl::writeOnce(const JointPositions&) { throw ControlException(kWrongForm); }
void ActiveControl::writeOnce(const JointVelocities&) { throw ControlException(kWrongForm); }
void ActiveControl::writeOnce(const CartesianPose&) { throw ControlException(kWrongForm); }
void ActiveControl::writeOnce(const CartesianVelocities&) { throw ControlException(kWrongForm); }

ActiveTorqueControl::ActiveTorqueControl(std::unique_ptr<Motion> motion)
    : ActiveControl(std::move(motion)) {}

void ActiveTorqueControl::writeOnce(const Torques& control_input) {
  motion_->write([&](const franka_core::RobotState& state, franka_core::RobotCommand& command) {
    shape(kUnshaped, control_input, state, command);
    return control_input.motion_finished;
  });
}

template <typename MotionGeneratorType>
ActiveMotionGenerator<MotionGeneratorType>::ActiveMotionGenerator(std::unique_ptr<Motion> motion)
    : ActiveControl(std::move(motion)) {}

template <typename MotionGeneratorType>
void ActiveMotionGenerator<MotionGeneratorType>::writeOnce(
    const MotionGeneratorType& motion_generator_input,
    const std::optional<const Torques>& control_input) {
  if (control_input.has_value() != motion_->needsTorques()) {
    throw ControlException(
        motion_->needsTorques()
            ? "libfranka: This motion was started with the external controller: each command needs "
              "torques as well."
            : "libfranka: This motion was not started with the external controller: it takes no "
              "torques.");
  }
  motion_->write([&](const franka_core::RobotState& state, franka_core::RobotCommand& command) {
    shape(kUnshaped, motion_generator_input, state, command);
    if (control_input) {
      shape(kUnshaped, *control_input, state, command);
    }
    return motion_generator_input.motion_finished ||
           (control_input && control_input->motion_finished);
  });
}

template <typename MotionGeneratorType>
void ActiveMotionGenerator<MotionGeneratorType>::writeOnce(
    const MotionGeneratorType& motion_generator_input) {
  writeOnce(motion_generator_input, std::nullopt);
}

template class ActiveMotionGenerator<JointPositions>;
template class ActiveMotionGenerator<JointVelocities>;
template class ActiveMotionGenerator<CartesianPose>;
template class ActiveMotionGenerator<CartesianVelocities>;

ActiveControl::Motion::Motion(std::shared_ptr<Robot::Impl> robot,
                              const std::function<franka_core::fci::MoveRequest()>& checked_request)
    : robot_(std::move(robot)) {
  operation_.emplace(*robot_);
  const franka_core::fci::MoveRequest request = checked_request();
  needs_torques_ = request.controller_mode == franka_core::ControllerMode::kExternalController;
  robot_->prepareThreadForMotion();
  running_.emplace(*robot_, request);
}

ActiveControl::Motion::~Motion() {
  if (running_) {
    running_->cancel();
  }
}

void ActiveControl::Motion::requireRunning() const {
  if (!running_) {
    throw ControlException(kEnded);
  }
}

void ActiveControl::Motion::end() noexcept {
  running_.reset();
  operation_.reset();
}

std::pair<RobotState, Duration> ActiveControl::Motion::read() {
  requireRunning();
  std::pair<RobotState, Duration> result;
  const franka_core::RobotState& state = running_->receive();
  franka_core::toFranka(state, result.first);
  result.second = Duration(state.message_id - last_time_.value_or(state.message_id));
  last_time_ = state.message_id;
  return result;
}

template <typename Fill>
void ActiveControl::Motion::write(Fill fill) {
  requireRunning();
  if (!fill(robot_->state(), command_)) {
    running_->send(command_);
    return;
  }
  running_->finish(command_);
  end();
}

}  // namespace franka
