// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/safety/safety_monitor.h"

#include <franka_core/transform.h>
#include <franka_sim/robot/limits.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/transforms.h"

namespace franka_sim {

using franka_core::RobotError;

namespace {

// Chosen here (see ForceWatch): no rule is published.
constexpr double kTolerance = 10.0;  // [Nm]
constexpr int kPatience = 100;       // [ticks]

}  // namespace

ErrorSet ForceWatch::update(const std::array<double, 7>& tau_ext,
                            const std::array<double, 7>& achieved,
                            const std::array<double, 7>& desired,
                            const std::array<double, 7>& range) noexcept {
  bool beyond = false;
  bool misses = false;
  for (std::size_t i = 0; i < 7; i++) {
    beyond |= std::abs(tau_ext[i]) > range[i];
    misses |= std::abs(achieved[i] - desired[i]) > kTolerance;
  }
  missed_ = misses ? missed_ + 1 : 0;
  ErrorSet errors;
  errors.addIf(beyond, RobotError::kForceControlSafetyViolation);
  errors.addIf(missed_ >= kPatience, RobotError::kForceControllerDesiredForceToleranceViolation);
  return errors;
}

using franka_core::fci::CartesianLimit;

namespace {

constexpr double kDepthJitter = 1e-4;  // [m], chosen here: allowed growth of the depth at rest

}  // namespace

bool VirtualWalls::set(std::int32_t id, const CartesianLimit& wall) noexcept {
  const bool sensible =
      std::all_of(wall.object_world_size.begin(), wall.object_world_size.end(),
                  [](double edge) { return std::isfinite(edge) && edge >= 0.0; }) &&
      franka_core::isRigidTransform(wall.object_frame);
  if (get(id) == nullptr || !sensible) {
    return false;
  }
  walls_[static_cast<std::size_t>(id)] = wall;
  return true;
}

const CartesianLimit* VirtualWalls::get(std::int32_t id) const noexcept {
  return id >= 0 && static_cast<std::size_t>(id) < kCount ? &walls_[static_cast<std::size_t>(id)]
                                                          : nullptr;
}

// Depth inside; 0 or less outside.
double VirtualWalls::depth(const CartesianLimit& wall,
                           const std::array<double, 16>& O_T_EE) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> frame(wall.object_frame.data());
  const Eigen::Vector3d away(O_T_EE[12] - frame(0, 3), O_T_EE[13] - frame(1, 3),
                             O_T_EE[14] - frame(2, 3));
  const Eigen::Vector3d inside = frame.topLeftCorner<3, 3>().transpose() * away;
  double depth = 0.5 * wall.object_world_size[0] - std::abs(inside[0]);
  for (int i = 1; i < 3; i++) {
    depth = std::min(
        depth, 0.5 * wall.object_world_size[static_cast<std::size_t>(i)] - std::abs(inside[i]));
  }
  return depth;
}

void VirtualWalls::begin(const std::array<double, 16>& O_T_EE) noexcept {
  for (std::size_t i = 0; i < kCount; i++) {
    allowed_[i] = walls_[i].active ? std::max(0.0, depth(walls_[i], O_T_EE) + kDepthJitter) : 0.0;
  }
}

bool VirtualWalls::violated(const std::array<double, 16>& O_T_EE) noexcept {
  for (std::size_t i = 0; i < kCount; i++) {
    if (!walls_[i].active) {
      continue;
    }
    const double now = depth(walls_[i], O_T_EE);
    if (now > allowed_[i]) {
      return true;
    }
    allowed_[i] = std::max(0.0, std::min(allowed_[i], now + kDepthJitter));
  }
  return false;
}

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;

namespace {

template <std::size_t N>
bool any(const std::array<double, N>& values) noexcept {
  return std::any_of(values.begin(), values.end(), [](double value) { return value != 0.0; });
}

}  // namespace

void SafetyMonitor::motionBegins() noexcept {
  self_collision_.begin(configuration_->parameters().model, state_->q);
  walls_.begin(state_->O_T_EE);
}

void SafetyMonitor::check(const MotionLimits& limits,
                          const CollisionThresholds& thresholds) noexcept {
  const Estimate& estimate = estimator_->estimate();
  raise(measuredViolations(limits.arm, *state_, estimate.O_dP_EE));
  if (any(state_->joint_collision)) {
    joint_collision_ = worstOf(estimate.tau_ext, thresholds.upper_torque);
    raise(RobotError::kJointReflex);
  }
  if (any(state_->cartesian_collision)) {
    cartesian_collision_ = worstOf(estimate.wrench, thresholds.upper_force);
    raise(RobotError::kCartesianReflex);
  }
}

void SafetyMonitor::checkMotion(const franka_core::fci::MoveRequest& motion,
                                const MotionLimits& limits,
                                const std::array<double, 7>& motor_torques) noexcept {
  const ControlUnitParameters& parameters = configuration_->parameters();
  const bool outside = motion.controller_mode == ControllerMode::kExternalController;
  // An external controller may move the arm anywhere, even if a motion generator runs.
  const bool generated = !outside && motion.motion_generator_mode != MotionGeneratorMode::kNone;
  if (self_collision_.violated(parameters.model, generated ? state_->q_d : state_->q)) {
    raise(RobotError::kSelfCollisionAvoidanceViolation);
  }
  if (walls_.violated(state_->O_T_EE)) {
    raise(RobotError::kCartesianPositionLimitsViolation);
  }
  if (outside) {
    raise(force_watch_.update(estimator_->estimate().tau_ext, state_->tau_J, motor_torques,
                              parameters.max_torque));
    return;
  }
  if (deviates(*state_, motion.max_path_deviation)) {
    raise(RobotError::kMaxPathPoseDeviationViolation);
  }
  if (movesAgainstProfile(motion, limits)) {
    raise(RobotError::kCartesianVelocityProfileSafetyViolation);
  }
}

// Chosen here, because no rule is published: the measured velocity differs from the desired one by
// more than the limit of speed.
bool SafetyMonitor::movesAgainstProfile(const franka_core::fci::MoveRequest& motion,
                                        const MotionLimits& limits) const noexcept {
  const bool cartesian = motion.motion_generator_mode == MotionGeneratorMode::kCartesianPosition ||
                         motion.motion_generator_mode == MotionGeneratorMode::kCartesianVelocity;
  const std::array<double, 6>& measured = estimator_->estimate().O_dP_EE;
  const std::array<double, 6>& desired = state_->O_dP_EE_d;
  return cartesian && std::hypot(measured[0] - desired[0], measured[1] - desired[1],
                                 measured[2] - desired[2]) > limits.arm.translation.velocity;
}

void CommandWindow::record(bool received) noexcept {
  received_[next_] = received;
  next_ = (next_ + 1) % kSlots;
  if (seen_ < kSlots) {
    seen_++;
  }
}

double CommandWindow::rate() const noexcept {
  return seen_ == 0 ? 0.0 : static_cast<double>(received_.count()) / static_cast<double>(seen_);
}

void CommandWindow::clear() noexcept {
  received_.reset();
  next_ = 0;
  seen_ = 0;
}

bool LossMonitor::record(bool received, int patience) noexcept {
  begun_ = begun_ || received;
  lost_ = received ? 0 : lost_ + 1;
  if (!begun_) {
    return lost_ >= patience;
  }
  window_.record(received);
  return lost_ >= kLostInARow;
}

void LossMonitor::restart() noexcept {
  window_.clear();
  lost_ = 0;
  begun_ = false;
}

}  // namespace franka_sim
