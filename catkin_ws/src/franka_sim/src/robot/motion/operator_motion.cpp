// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/motion_limits.h>
#include <franka_core/smooth_step.h>
#include <franka_sim/robot/motion/operator_motion.h>
#include <franka_sim/robot/plant.h>

#include <algorithm>

namespace franka_sim {

using franka_core::RobotMode;

namespace {

// Of smoothStep: largest second derivative, 10 / sqrt(3), and third derivative.
constexpr double kStepAcceleration = 5.7735;
constexpr double kStepJerk = 60.0;
// Share of the joints' accelerations and jerks that a motion uses (chosen here).
constexpr double kGentle = 0.5;
// Velocity limits below this decide about the way's time only where they apply, not about the whole
// duration [rad/s] (chosen here: from such a speed to rest is a small step of the acceleration).
constexpr double kCreep = 0.05;
// Used share of a velocity limit, so that rounding never exceeds it.
constexpr double kShareOfLimit = 0.999;
// Of an interval of time: enough to find the last double in it.
constexpr int kHalvings = 60;

// First derivative of smoothStep.
double stepVelocity(double share) noexcept {
  return 30.0 * share * share * (1.0 - share) * (1.0 - share);
}

}  // namespace

// In the direction of the motion [rad/s].
double OperatorMotion::velocityLimit(std::size_t joint, double q) const noexcept {
  const franka_core::MotionLimits& limits = unit_->limits();
  return to_[joint] > from_[joint] ? limits.highestVelocity(joint, q)
                                   : -limits.lowestVelocity(joint, q);
}

// Joint velocity limits may depend on the position, so the way is sampled.
double OperatorMotion::shortestDuration(double speed) const noexcept {
  constexpr int kSamples = 200;
  const franka_core::MotionLimits& limits = unit_->limits();
  double duration = 0.1;
  for (std::size_t i = 0; i < to_.size(); i++) {
    const double way = to_[i] - from_[i];
    const double size = std::abs(way);
    duration =
        std::max({duration, std::sqrt(kStepAcceleration * size / (kGentle * limits.arm.ddq[i])),
                  std::cbrt(kStepJerk * size / (kGentle * limits.arm.dddq[i]))});
    for (int k = 1; k < kSamples; k++) {
      const double share = static_cast<double>(k) / kSamples;
      const double q = from_[i] + way * franka_core::smoothStep(share);
      if (size > 0.0) {
        const double limit = std::max(velocityLimit(i, q), kCreep);
        duration = std::max(duration, size * stepVelocity(share) / (speed * limit));
      }
    }
  }
  return duration;
}

// The largest share of the way at which this tick may end without exceeding a velocity limit.
double OperatorMotion::farthestShare() const noexcept {
  const double share = franka_core::smoothStep(time_ / duration_);
  double farthest = 1.0;
  for (std::size_t i = 0; i < to_.size(); i++) {
    const double size = std::abs(to_[i] - from_[i]);
    const double step = kShareOfLimit * velocityLimit(i, command_.q_c[i]) * kTick;
    if (step < (1.0 - share) * size) {
      farthest = std::min(farthest, share + step / size);
    }
  }
  return farthest;
}

// A tick later than now, or less where a velocity limit demands it.
double OperatorMotion::nextTime() const noexcept {
  const double farthest = farthestShare();
  double late = std::min(time_ + kTick, duration_);
  if (franka_core::smoothStep(late / duration_) <= farthest) {
    return late;
  }
  double early = time_;
  for (int i = 0; i < kHalvings; i++) {
    const double middle = 0.5 * (early + late);
    (franka_core::smoothStep(middle / duration_) <= farthest ? early : late) = middle;
  }
  return early;
}

std::optional<std::size_t> OperatorMotion::jointOutOfReach(
    const std::array<double, 7>& q) const noexcept {
  for (std::size_t i = 0; i < q.size(); i++) {
    const franka_core::JointRange reach = unit_->limits().reachFrom(i, unit_->state().q_d[i]);
    if (!(q[i] >= reach.lowest && q[i] <= reach.highest)) {
      return i;
    }
  }
  return std::nullopt;
}

Status OperatorMotion::start(const std::array<double, 7>& q, double speed) noexcept {
  if (jointOutOfReach(q) || !(speed > 0.0 && speed <= 1.0)) {
    return Status::kInvalidArgumentRejected;
  }
  OperatorMove request;
  request.move.max_path_deviation = {10.0, 3.14, 6.28};  // no limit
  request.move.max_goal_deviation = request.move.max_path_deviation;
  const Status answer = unit_->request(request).value_or(Status::kAborted);
  if (answer != Status::kMotionStarted) {
    return answer;
  }
  from_ = unit_->state().q_d;
  to_ = q;
  command_ = {};
  command_.q_c = from_;
  time_ = 0.0;
  duration_ = shortestDuration(speed);
  active_ = true;
  arrived_ = false;
  return answer;
}

void OperatorMotion::stop() noexcept {
  if (active_) {
    active_ = false;
    unit_->request(franka_core::fci::StopMoveRequest{});
  }
}

const franka_core::RobotCommand* OperatorMotion::command() noexcept {
  if (!active_) {
    return nullptr;
  }
  if (unit_->state().robot_mode != RobotMode::kMove) {
    active_ = false;
    arrived_ = command_.motion_generation_finished && unit_->state().robot_mode == RobotMode::kIdle;
    return nullptr;
  }
  time_ = nextTime();
  const double share = franka_core::smoothStep(time_ / duration_);
  for (std::size_t i = 0; i < to_.size(); i++) {
    command_.q_c[i] = share < 1.0 ? from_[i] + share * (to_[i] - from_[i]) : to_[i];
  }
  command_.motion_generation_finished = time_ >= duration_;
  return &command_;
}

}  // namespace franka_sim
