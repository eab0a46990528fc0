// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/smooth_step.h>
#include <franka_sim/robot/operator_motion.h>
#include <franka_sim/robot/tick.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace franka_sim {

using franka_core::RobotMode;

namespace {

// Chosen here: folded above the shoulder, within the limits of both robots.
constexpr std::array<double, 7> kPandaPack{0.0, -0.56, 0.0, -2.95, 0.0, 2.4, M_PI_4};
constexpr std::array<double, 7> kFr3Pack{0.0, -0.56, 0.0, -2.95, 0.0, 2.4, M_PI_4};

// Of smoothStep: largest second derivative, 10 / sqrt(3), and third derivative.
constexpr double kStepAcceleration = 5.7735;
constexpr double kStepJerk = 60.0;
// Share of the joints' accelerations and jerks that a motion uses (chosen here).
constexpr double kGentle = 0.5;

// First derivative of smoothStep.
double stepVelocity(double share) noexcept {
  return 30.0 * share * share * (1.0 - share) * (1.0 - share);
}

}  // namespace

std::array<double, 7> OperatorMotion::packPose(bool fr3) noexcept {
  return fr3 ? kFr3Pack : kPandaPack;
}

// Joint velocity limits may depend on the position, so the way is sampled.
double OperatorMotion::shortestDuration(double speed) const noexcept {
  constexpr int kSamples = 200;
  const MotionLimits& limits = unit_.limits();
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
      const double limit = way > 0.0 ? limits.highestVelocity(i, q) : -limits.lowestVelocity(i, q);
      if (size > 0.0) {
        duration = std::max(duration, size * stepVelocity(share) / (speed * std::max(limit, 0.01)));
      }
    }
  }
  return duration;
}

Status OperatorMotion::start(const std::array<double, 7>& q, double speed) noexcept {
  const MotionLimits& limits = unit_.limits();
  for (std::size_t i = 0; i < q.size(); i++) {
    if (!(q[i] >= limits.arm.q_min[i] && q[i] <= limits.arm.q_max[i])) {
      return Status::kInvalidArgumentRejected;
    }
  }
  if (!(speed > 0.0 && speed <= 1.0)) {
    return Status::kInvalidArgumentRejected;
  }
  OperatorMove request;
  request.move.max_path_deviation = {10.0, 3.14, 6.28};  // no limit
  request.move.max_goal_deviation = request.move.max_path_deviation;
  const Status answer = unit_.request(request).value_or(Status::kAborted);
  if (answer != Status::kMotionStarted) {
    return answer;
  }
  from_ = unit_.state().q_d;
  to_ = q;
  time_ = 0.0;
  duration_ = shortestDuration(speed);
  active_ = true;
  arrived_ = false;
  return answer;
}

void OperatorMotion::stop() noexcept {
  if (active_) {
    active_ = false;
    unit_.request(franka_core::fci::StopMoveRequest{});
  }
}

const franka_core::RobotCommand* OperatorMotion::command() noexcept {
  if (!active_) {
    return nullptr;
  }
  if (unit_.state().robot_mode != RobotMode::kMove) {
    active_ = false;
    arrived_ = command_.motion_generation_finished && unit_.state().robot_mode == RobotMode::kIdle;
    return nullptr;
  }
  time_ = std::min(time_ + kTick, duration_);
  const double share = franka_core::smoothStep(time_ / duration_);
  for (std::size_t i = 0; i < to_.size(); i++) {
    command_.q_c[i] = from_[i] + share * (to_[i] - from_[i]);
  }
  command_.motion_generation_finished = time_ >= duration_;
  return &command_;
}

}  // namespace franka_sim
