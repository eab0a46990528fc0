// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/supervisor/client_motion.h"

#include <franka_core/finite.h>

namespace franka_sim {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotError;

bool ClientMotion::hasGenerator() const noexcept {
  return request_.motion_generator_mode != MotionGeneratorMode::kNone;
}

bool ClientMotion::hasExternalController() const noexcept {
  return request_.controller_mode == ControllerMode::kExternalController;
}

MotionStartResult ClientMotion::start(const franka_core::fci::MoveRequest& request, bool continued,
                                      const franka_core::RobotState& state,
                                      const franka_core::ArmModel& model) noexcept {
  if (request.motion_generator_mode != MotionGeneratorMode::kNone) {
    MotionStart start;
    start.mode = request.motion_generator_mode;
    start.q_d = state.q_d;
    start.F_T_EE = state.F_T_EE;
    start.continued = continued;
    start.asynchronous = request.use_async_motion_generator;
    start.maximum_velocity = request.maximum_velocity;
    const MotionStartResult result = generator_.start(start, model);
    if (result != MotionStartResult::kStarted) {
      return result;
    }
  }
  request_ = request;
  return MotionStartResult::kStarted;
}

ClientMotion::Step ClientMotion::step(const franka_core::RobotCommand* command, bool reflexes,
                                      const franka_core::ArmModel& model) noexcept {
  Step step;
  if (command != nullptr && !reflexes && !franka_core::allFinite(command->tau_J_d)) {
    command = nullptr;
  }
  const bool due = !request_.use_async_motion_generator;
  if ((due || command != nullptr) && losses_.record(command != nullptr) && reflexes) {
    step.errors.add(RobotError::kCommunicationConstraintsViolation);
  }
  if (command != nullptr) {
    command = &filter_.apply(*command);
  }
  if (hasGenerator()) {
    const MotionStep motion = generator_.step(command, model);
    step.errors.add(motion.errors);
    step.generated = !motion.errors;
    step.finished = step.generated && motion.finished;
  } else {
    step.finished = command != nullptr && command->torque_command_finished;
  }
  if (hasExternalController() && command != nullptr) {
    const bool jumps = reflexes && torque_.jumps(command->tau_J_d);
    step.errors.addIf(jumps || !torque_.receive(command->tau_J_d),
                      RobotError::kControllerTorqueDiscontinuity);
  }
  return step;
}

void ClientMotion::clear() noexcept {
  losses_.restart();
  torque_.clear();
}

}  // namespace franka_sim
