// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/motion_generator.h"

#include <franka_core/finite.h>
#include <franka_core/tick.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/motion/cartesian_motion.h"
#include "robot/motion/inverse_kinematics.h"
#include "robot/motion/joint_motion.h"

namespace franka_sim {

using franka_core::kTick;
using franka_core::RobotError;

namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;
using franka_core::MotionGeneratorMode;
using Joints = std::array<double, 7>;
using Twist = std::array<double, 6>;

constexpr double kAcceleratingShare = 0.1;  // of an acceleration limit (decision 15)
constexpr double kEcho = 1e-6;  // [rad] change of a position on its way to the client and back

bool allPositive(const Joints& values) noexcept {
  return std::all_of(values.begin(), values.end(), [](double v) { return v > 0.0; });
}

double norm(const Twist& twist, std::size_t first) noexcept {
  return Eigen::Map<const Eigen::Vector3d>(twist.data() + first).norm();
}

bool isCartesianMode(MotionGeneratorMode mode) noexcept {
  return mode == MotionGeneratorMode::kCartesianPosition ||
         mode == MotionGeneratorMode::kCartesianVelocity;
}

bool isJointMode(MotionGeneratorMode mode) noexcept {
  return mode == MotionGeneratorMode::kJointPosition || mode == MotionGeneratorMode::kJointVelocity;
}

bool isPossible(const MotionStart& start) noexcept {
  if (!franka_core::allFinite(start.q_d)) {
    return false;
  }
  if (start.asynchronous) {
    return start.mode == MotionGeneratorMode::kJointPosition &&
           franka_core::allFinite(start.maximum_velocity) && allPositive(start.maximum_velocity);
  }
  return isJointMode(start.mode) || isCartesianMode(start.mode);
}

}  // namespace

MotionGenerator::MotionGenerator(const franka_core::MotionLimits& limits) noexcept
    : limits_(limits) {}

bool MotionGenerator::isCartesian() const noexcept { return isCartesianMode(start_.mode); }

MotionStartResult MotionGenerator::start(const MotionStart& start, const ArmModel& model) noexcept {
  if (!isPossible(start)) {
    return MotionStartResult::kInvalidArgument;
  }
  if (isCartesianMode(start.mode) && !start.continued &&
      InverseKinematics::isSingular(start.q_d, start.F_T_EE, model)) {
    return MotionStartResult::kSingular;
  }
  start_ = start;
  solved_ = false;
  finishing_ = false;
  joints_.start(start.q_d);
  async_.start(start.q_d, start.maximum_velocity);
  desired_ = DesiredMotion{};
  publishJoints(model);
  cartesian_.start(desired_.O_T_EE_c, desired_.elbow_c);
  return MotionStartResult::kStarted;
}

MotionStep MotionGenerator::step(const franka_core::RobotCommand* command,
                                 const ArmModel& model) noexcept {
  MotionStep result;
  const bool finish = command != nullptr && command->motion_generation_finished;
  if (start_.asynchronous) {
    if (finish) {
      async_.stop();
      finishing_ = true;
    }
    // The finishing command is not a target: genuine clients leave its numbers zero.
    result.errors = advanceAsync(finishing_ ? nullptr : command);
    result.finished = finishing_ && async_.atRest();
  } else {
    result.errors = isCartesian() ? advanceCartesian(command, model) : advanceJoints(command);
    result.finished = finish;
    if (finish && !result.errors) {
      result.errors = isCartesian() ? cartesian_.checkStop(limits_) : joints_.checkStop(limits_);
    }
  }
  if (!result.errors && !isCartesian()) {
    publishJoints(model);
  }
  return result;
}

ErrorSet MotionGenerator::advanceAsync(const franka_core::RobotCommand* command) noexcept {
  if (command != nullptr) {
    if (!franka_core::allFinite(command->q_c)) {
      return RobotError::kJointMotionGeneratorVelocityLimitsViolation;  // no velocity leads there
    }
    Joints target;
    for (std::size_t i = 0; i < 7; i++) {
      const franka_core::JointRange reach = limits_.reachFrom(i, async_.position()[i]);
      if (command->q_c[i] > reach.highest + kEcho || command->q_c[i] < reach.lowest - kEcho) {
        return limits_.positionFlag(false);
      }
      target[i] = std::min(std::max(command->q_c[i], reach.lowest), reach.highest);
    }
    async_.setTarget(target);
  }
  async_.step(limits_);
  joints_.follow(async_.sample());
  return {};
}

ErrorSet MotionGenerator::advanceJoints(const franka_core::RobotCommand* command) noexcept {
  if (command == nullptr) {
    return joints_.extrapolate(limits_);
  }
  return start_.mode == MotionGeneratorMode::kJointPosition
             ? joints_.takePositions(command->q_c, limits_)
             : joints_.takeVelocities(command->dq_c, limits_);
}

ErrorSet MotionGenerator::advanceCartesian(const franka_core::RobotCommand* command,
                                           const ArmModel& model) noexcept {
  ErrorSet errors;
  if (command == nullptr) {
    errors = cartesian_.extrapolate(limits_);
  } else {
    const ElbowCommand elbow{command->valid_elbow, command->elbow_c};
    const double sign = elbowSign(desired_.q_d);
    errors = start_.mode == MotionGeneratorMode::kCartesianPosition
                 ? cartesian_.takePose(command->O_T_EE_c, elbow, sign, limits_)
                 : cartesian_.takeTwist(command->O_dP_EE_c, elbow, sign, limits_);
  }
  if (errors) {
    if (const CartesianSample* refused = cartesian_.refused()) {
      errors.add(joints_.checkJump(solve(*refused, model).q, limits_));
    }
    return errors;
  }
  if (command == nullptr && !solved_) {
    return errors;  // waits for the first command
  }
  const InverseKinematics::Solution solution = solve(cartesian_.last(), model);
  errors = joints_.takeSolved(solution.q, !solved_, limits_);
  if (!errors) {
    solved_ = true;
    publishCartesian(solution);
  }
  return errors;
}

InverseKinematics::Solution MotionGenerator::solve(const CartesianSample& commanded,
                                                   const ArmModel& model) const noexcept {
  return InverseKinematics::solve(desired_.q_d, commanded.pose, commanded.elbow.q3, start_.F_T_EE,
                                  model);
}

void MotionGenerator::publishJoints(const ArmModel& model) noexcept {
  const JointSample& sample = joints_.last();
  const Twist before = desired_.O_dP_EE_c;
  desired_.q_d = sample.q;
  desired_.dq_d = sample.dq;
  desired_.ddq_d = sample.ddq;
  desired_.O_T_EE_c = model.pose(ArmFrame::kEndEffector, sample.q, start_.F_T_EE);
  desired_.O_T_EE_d = desired_.O_T_EE_c;
  desired_.O_dP_EE_c =
      twist(model.zeroJacobian(ArmFrame::kEndEffector, sample.q, start_.F_T_EE), sample.dq);
  desired_.O_dP_EE_d = desired_.O_dP_EE_c;
  for (std::size_t i = 0; i < 6; i++) {
    desired_.O_ddP_EE_c[i] = (desired_.O_dP_EE_c[i] - before[i]) / kTick;
  }
  desired_.elbow_c = elbowOf(sample.q);
  desired_.elbow_d = desired_.elbow_c;
  desired_.delbow_c = {{sample.dq[2], 0.0}};
  desired_.ddelbow_c = {{sample.ddq[2], 0.0}};
  publishAcceleration();
}

void MotionGenerator::publishCartesian(const InverseKinematics::Solution& solution) noexcept {
  const JointSample& sample = joints_.last();
  const CartesianSample& commanded = cartesian_.last();
  desired_.q_d = sample.q;
  desired_.dq_d = sample.dq;
  desired_.ddq_d = sample.ddq;
  desired_.O_T_EE_c = commanded.pose;
  desired_.O_dP_EE_c = commanded.twist;
  desired_.O_ddP_EE_c = commanded.acceleration;
  desired_.O_T_EE_d = solution.O_T_EE;
  desired_.O_dP_EE_d = twist(solution.jacobian, sample.dq);
  desired_.elbow_d = elbowOf(sample.q);
  desired_.elbow_c = {{commanded.elbow.q3, elbowSign(sample.q)}};
  desired_.delbow_c = {{commanded.elbow.dq3, 0.0}};
  desired_.ddelbow_c = {{commanded.elbow.ddq3, 0.0}};
  desired_.near_singularity = solution.near_singularity;
  publishAcceleration();
}

void MotionGenerator::publishAcceleration() noexcept {
  const franka_core::ArmLimits& arm = limits_.arm;
  bool accelerating =
      norm(desired_.O_ddP_EE_c, 0) > kAcceleratingShare * arm.translation.acceleration ||
      norm(desired_.O_ddP_EE_c, 3) > kAcceleratingShare * arm.rotation.acceleration;
  for (std::size_t i = 0; i < 7; i++) {
    accelerating = accelerating || std::abs(desired_.ddq_d[i]) > kAcceleratingShare * arm.ddq[i];
  }
  desired_.accelerating = accelerating;
}

}  // namespace franka_sim
