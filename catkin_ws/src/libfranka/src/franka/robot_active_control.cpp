// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/active_motion_generator.h>
#include <franka/active_torque_control.h>
#include <franka/robot.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "franka/active_control_motion.h"
#include "franka/control_loop.h"

namespace franka {

namespace {

namespace fci = franka_core::fci;
using Mode = research_interface::robot::Move::ControllerMode;

franka_core::ControllerMode toWire(Mode mode) {
  switch (mode) {
    case Mode::kJointImpedance:
      return franka_core::ControllerMode::kJointImpedance;
    case Mode::kCartesianImpedance:
      return franka_core::ControllerMode::kCartesianImpedance;
    case Mode::kExternalController:
      return franka_core::ControllerMode::kExternalController;
  }
  throw std::invalid_argument("libfranka: Invalid controller mode given.");
}

fci::MoveRequest moveRequest(Mode mode, franka_core::MotionGeneratorMode generator) {
  fci::MoveRequest request;
  request.controller_mode = toWire(mode);
  request.motion_generator_mode = generator;
  return request;
}

std::array<double, 7> toVelocities(const std::vector<double>& velocities) {
  const auto is_positive = [](double v) { return std::isfinite(v) && v > 0.0; };
  if (velocities.size() < 7 || !std::all_of(velocities.begin(), velocities.end(), is_positive)) {
    throw std::invalid_argument(
        "libfranka: An asynchronous motion needs seven maximum joint velocities, each greater than "
        "0 rad/s.");
  }
  std::array<double, 7> result{};
  std::copy_n(velocities.begin(), 7, result.begin());
  return result;
}

}  // namespace

std::unique_ptr<ActiveControlBase> Robot::startTorqueControl() {
  const auto request = [this] {
    return moveRequest(Mode::kExternalController, torqueGeneratorOf(impl_->version()));
  };
  return std::unique_ptr<ActiveControlBase>(
      new ActiveTorqueControl(std::make_unique<ActiveControl::Motion>(impl_, request)));
}

std::unique_ptr<ActiveControlBase> Robot::startJointPositionControl(const Mode& control_type) {
  const auto request = [&] { return moveRequest(control_type, kGeneratorOf<JointPositions>); };
  return std::unique_ptr<ActiveControlBase>(new ActiveMotionGenerator<JointPositions>(
      std::make_unique<ActiveControl::Motion>(impl_, request)));
}

std::unique_ptr<ActiveControlBase> Robot::startJointVelocityControl(const Mode& control_type) {
  const auto request = [&] { return moveRequest(control_type, kGeneratorOf<JointVelocities>); };
  return std::unique_ptr<ActiveControlBase>(new ActiveMotionGenerator<JointVelocities>(
      std::make_unique<ActiveControl::Motion>(impl_, request)));
}

std::unique_ptr<ActiveControlBase> Robot::startCartesianPoseControl(const Mode& control_type) {
  const auto request = [&] { return moveRequest(control_type, kGeneratorOf<CartesianPose>); };
  return std::unique_ptr<ActiveControlBase>(new ActiveMotionGenerator<CartesianPose>(
      std::make_unique<ActiveControl::Motion>(impl_, request)));
}

std::unique_ptr<ActiveControlBase> Robot::startCartesianVelocityControl(const Mode& control_type) {
  const auto request = [&] { return moveRequest(control_type, kGeneratorOf<CartesianVelocities>); };
  return std::unique_ptr<ActiveControlBase>(new ActiveMotionGenerator<CartesianVelocities>(
      std::make_unique<ActiveControl::Motion>(impl_, request)));
}

std::unique_ptr<ActiveControlBase> Robot::startAsyncJointPositionControl(
    const Mode& control_type, const std::optional<std::vector<double>>& maximum_velocities) {
  const auto checked_request = [&] {
    if (!fci::hasAsyncMotion(impl_->version())) {
      throw CommandException(
          "libfranka: Move command rejected: asynchronous motions need an FR3 with system 5.9.0 or "
          "later (protocol version 10); this robot speaks version " +
          std::to_string(impl_->version()) + ".");
    }
    fci::MoveRequest request = moveRequest(control_type, kGeneratorOf<JointPositions>);
    request.use_async_motion_generator = true;
    request.maximum_velocity = toVelocities(maximum_velocities.value_or(std::vector<double>()));
    return request;
  };
  return std::unique_ptr<ActiveControlBase>(new ActiveMotionGenerator<JointPositions>(
      std::make_unique<ActiveControl::Motion>(impl_, checked_request)));
}

}  // namespace franka
