// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/safety/safety_monitor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/limits/deviation.h"
#include "robot/limits/measured_limits.h"

namespace franka_sim {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotError;

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

void SafetyMonitor::check(const franka_core::MotionLimits& limits,
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
                                const franka_core::MotionLimits& limits,
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
                                        const franka_core::MotionLimits& limits) const noexcept {
  const bool cartesian = motion.motion_generator_mode == MotionGeneratorMode::kCartesianPosition ||
                         motion.motion_generator_mode == MotionGeneratorMode::kCartesianVelocity;
  const std::array<double, 6>& measured = estimator_->estimate().O_dP_EE;
  const std::array<double, 6>& desired = state_->O_dP_EE_d;
  return cartesian && std::hypot(measured[0] - desired[0], measured[1] - desired[1],
                                 measured[2] - desired[2]) > limits.arm.translation.velocity;
}

}  // namespace franka_sim
