// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/motion_generator.h"

#include <franka_core/finite.h>
#include <franka_core/limits.h>
#include <franka_core/rotations.h>
#include <franka_core/transform.h>
#include <franka_sim/robot/plant.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "robot/transforms.h"

namespace franka_sim {

// From the rate r the value changes by kTick (r + (r - step) + ...); with n whole steps in r that
// is kTick ((n + 1) r - step n (n + 1) / 2).
double landingRate(double distance, double step) noexcept {
  const double units = distance / (step * kTick);
  const double n = std::floor((std::sqrt(1.0 + 8.0 * units) - 1.0) * 0.5);
  return (distance / kTick + step * n * (n + 1.0) * 0.5) / (n + 1.0);
}

void BrakeTrajectory::start(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                            const std::array<double, 7>& ddq_d,
                            const franka_core::ArmLimits& limits) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    q_[i] = q_d[i];
    dq_[i] = std::isfinite(dq_d[i]) ? dq_d[i] : 0.0;
    ddq_max_[i] = limits.ddq[i];
    change_[i] = limits.dddq[i] * kTick;
    ddq_[i] = std::isfinite(ddq_d[i]) ? std::clamp(ddq_d[i], -ddq_max_[i], ddq_max_[i]) : 0.0;
  }
}

void BrakeTrajectory::step() noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    const double direction = dq_[i] < 0.0 ? -1.0 : 1.0;
    const double landing = landingRate(std::abs(dq_[i]), change_[i]);
    const double braking = std::min({landing, ddq_max_[i], -direction * ddq_[i] + change_[i]});
    // The last step sets 0 itself, without rounding.
    const bool landed = braking == landing && landing <= change_[i];
    const double next = landed ? 0.0 : dq_[i] - direction * braking * kTick;
    ddq_[i] = (next - dq_[i]) / kTick;
    dq_[i] = next;
    q_[i] += next * kTick;
  }
}

bool BrakeTrajectory::atRest() const noexcept {
  const auto zero = [](double v) { return v == 0.0; };
  return std::all_of(dq_.begin(), dq_.end(), zero) && std::all_of(ddq_.begin(), ddq_.end(), zero);
}

namespace {

constexpr int kYieldTicks = 200;      // duration of yielding after a reflex (decision 16)
constexpr int kReflexTicks = 200;     // then braking restarts (decision 16)
constexpr int kMaxBrakeTicks = 2000;  // an arm at full speed comes to rest within half a second

}  // namespace

void RestSequence::brake(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
                         const std::array<double, 7>& ddq_d,
                         const franka_core::ArmLimits& limits) noexcept {
  brake_.start(q_d, dq_d, ddq_d, limits);
  phase_ = Phase::kBraking;
  ticks_ = 0;
}

std::array<double, 7> RestSequence::restingPosition() const noexcept {
  BrakeTrajectory brake = brake_;
  for (int i = 0; i < kMaxBrakeTicks && !brake.atRest(); ++i) {
    brake.step();
  }
  return brake.q();
}

RestSequence::Step RestSequence::step(bool reflex, const std::array<double, 7>& q,
                                      const std::array<double, 7>& dq,
                                      const franka_core::ArmLimits& limits) noexcept {
  if (phase_ == Phase::kReached) {
    return Step::kNone;
  }
  ticks_++;
  if (phase_ == Phase::kYielding) {
    phase_ = ticks_ < kYieldTicks ? Phase::kYielding : Phase::kReached;
    return Step::kYields;
  }
  brake_.step();
  if (reflex && ticks_ == kReflexTicks && !brake_.atRest()) {
    // From here on the arm does not press on an obstacle (decision 16).
    brake_.start(q, dq, {}, limits);
  }
  if (!brake_.atRest()) {
    return Step::kBrakes;
  }
  phase_ = reflex ? Phase::kYielding : Phase::kReached;
  ticks_ = 0;
  return Step::kStops;
}

namespace {

constexpr double kOff = 1000.0;  // [Hz]

double gainOf(double cutoff) noexcept {
  return cutoff >= kOff ? 1.0 : kTick / (kTick + 1.0 / (2.0 * 3.14159265358979323846 * cutoff));
}

template <std::size_t N>
void smooth(double gain, const std::array<double, N>& input,
            std::array<double, N>& output) noexcept {
  for (std::size_t i = 0; i < N; i++) {
    output[i] = gain >= 1.0 ? input[i] : gain * input[i] + (1.0 - gain) * output[i];
  }
}

void smoothPose(double gain, const Transform& input, Transform& output) noexcept {
  if (gain >= 1.0 || !franka_core::isRigidTransform(input)) {
    output = input;
    return;
  }
  const Eigen::Map<const Eigen::Matrix4d> next(input.data());
  Eigen::Map<Eigen::Matrix4d> last(output.data());
  const Eigen::Quaterniond from(franka_core::orthonormalized(last.topLeftCorner<3, 3>()));
  const Eigen::Quaterniond to(franka_core::orthonormalized(next.topLeftCorner<3, 3>()));
  last.topLeftCorner<3, 3>() = from.slerp(gain, to).toRotationMatrix();
  last.topRightCorner<3, 1>() += gain * (next.topRightCorner<3, 1>() - last.topRightCorner<3, 1>());
}

}  // namespace

bool CommandFilter::set(const franka_core::fci::SetFiltersRequest& cutoffs) noexcept {
  bool active = false;
  for (const double cutoff :
       {cutoffs.joint_position, cutoffs.joint_velocity, cutoffs.cartesian_position,
        cutoffs.cartesian_velocity, cutoffs.controller}) {
    if (!(cutoff >= 1.0 && cutoff <= kOff)) {
      return false;
    }
    active = active || cutoff < kOff;
  }
  cutoffs_ = cutoffs;
  active_ = active;
  return true;
}

void CommandFilter::begin(const franka_core::RobotState& state) noexcept {
  last_ = franka_core::RobotCommand();
  last_.q_c = state.q_d;
  last_.O_T_EE_c = state.O_T_EE_c;
  last_.elbow_c = state.elbow_c;
}

const franka_core::RobotCommand& CommandFilter::apply(
    const franka_core::RobotCommand& command) noexcept {
  if (!active_) {
    return command;
  }
  const franka_core::RobotCommand before = last_;
  last_ = command;
  last_.q_c = before.q_c;
  last_.dq_c = before.dq_c;
  last_.O_T_EE_c = before.O_T_EE_c;
  last_.O_dP_EE_c = before.O_dP_EE_c;
  last_.tau_J_d = before.tau_J_d;
  last_.elbow_c = before.elbow_c;
  smooth(gainOf(cutoffs_.joint_position), command.q_c, last_.q_c);
  smooth(gainOf(cutoffs_.joint_velocity), command.dq_c, last_.dq_c);
  smoothPose(gainOf(cutoffs_.cartesian_position), command.O_T_EE_c, last_.O_T_EE_c);
  smooth(gainOf(cutoffs_.cartesian_velocity), command.O_dP_EE_c, last_.O_dP_EE_c);
  smooth(gainOf(cutoffs_.controller), command.tau_J_d, last_.tau_J_d);
  if (command.valid_elbow) {
    smooth(gainOf(cutoffs_.cartesian_position), command.elbow_c, last_.elbow_c);
    last_.elbow_c[1] = command.elbow_c[1];
  }
  return last_;
}

namespace {

constexpr double kShare = 0.999;  // used share of the limits, so that rounding never exceeds them

}  // namespace

void AsyncJointGenerator::start(const std::array<double, 7>& q,
                                const std::array<double, 7>& maximum_velocity) noexcept {
  target_ = q;
  maximum_velocity_ = maximum_velocity;
  q_ = q;
  dq_.fill(0.0);
  history_.fill(q);
  newest_ = 0;
  sample_ = JointSample{};
  sample_.q = q;
  stopping_ = false;
}

void AsyncJointGenerator::step(const MotionLimits& limits) noexcept {
  JointSample next;
  newest_ = (newest_ + 1) % kWindow;
  for (std::size_t i = 0; i < 7; i++) {
    const double step = kShare * limits.arm.ddq[i] * kTick;
    const double distance = target_[i] - q_[i];
    const double landing = std::copysign(landingRate(std::abs(distance), step), distance);
    const double up = kShare * std::min(maximum_velocity_[i], limits.highestVelocity(i, q_[i]));
    const double down = kShare * std::max(-maximum_velocity_[i], limits.lowestVelocity(i, q_[i]));
    const double desired = stopping_ ? 0.0 : std::min(std::max(landing, down), up);
    const double before = dq_[i];
    dq_[i] = std::min(std::max(desired, before - step), before + step);
    // The last step sets the target itself, without rounding.
    const bool landed = !stopping_ && dq_[i] == landing && std::abs(landing) <= step;
    q_[i] = landed ? target_[i] : q_[i] + dq_[i] * kTick;
    target_[i] = stopping_ && dq_[i] == 0.0 ? q_[i] : target_[i];
    history_[newest_][i] = q_[i];
    // Differences to the first value keep the mean of equal values exact.
    double mean = 0.0;
    for (const std::array<double, 7>& past : history_) {
      mean += past[i] - q_[i];
    }
    next.q[i] = q_[i] + mean / kWindow;
    next.dq[i] = (next.q[i] - sample_.q[i]) / kTick;
    next.ddq[i] = (next.dq[i] - sample_.dq[i]) / kTick;
    next.dddq[i] = (next.ddq[i] - sample_.ddq[i]) / kTick;
  }
  sample_ = next;
}

bool AsyncJointGenerator::atRest() const noexcept {
  return q_ == target_ && sample_.q == q_ && sample_.dq == std::array<double, 7>{};
}

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

MotionGenerator::MotionGenerator(const MotionLimits& limits) noexcept : limits_(limits) {}

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
  showJoints(model);
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
    showJoints(model);
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
    showCartesian(solution);
  }
  return errors;
}

InverseKinematics::Solution MotionGenerator::solve(const CartesianSample& commanded,
                                                   const ArmModel& model) const noexcept {
  return InverseKinematics::solve(desired_.q_d, commanded.pose, commanded.elbow.q3, start_.F_T_EE,
                                  model);
}

void MotionGenerator::showJoints(const ArmModel& model) noexcept {
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
  showAcceleration();
}

void MotionGenerator::showCartesian(const InverseKinematics::Solution& solution) noexcept {
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
  showAcceleration();
}

void MotionGenerator::showAcceleration() noexcept {
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
