// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/joint_checks.h"

#include <franka_sim/robot/tick.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/motion/as_echoed.h"

namespace franka_sim {

namespace {

// A velocity limit that shrinks with the position cannot be kept by braking within the jerk limit
// (at 17 rad/s^2 not even within the acceleration limit). A client that brakes like the rate
// limiter of its library is accepted nevertheless: a rate-limited client is never aborted.
// Tolerances for the limiter's margins:
constexpr double kBrakingShare = 0.999;
constexpr double kClientMargin = 1e-3;  // the client's margin to a velocity limit [rad/s]

/// A joint seen in its direction of motion.
struct Directed {
  double dq, ddq, last_dq;
  double limit;      // there, at the last position
  double far_limit;  // away from the joint's end
};

Directed upwards(const JointSample& step, const JointSample& last, const MotionLimits& limits,
                 std::size_t i) noexcept {
  return {step.dq[i], step.ddq[i], last.dq[i], limits.highestVelocity(i, last.q[i]),
          limits.arm.dq[i]};
}

Directed downwards(const JointSample& step, const JointSample& last, const MotionLimits& limits,
                   std::size_t i) noexcept {
  return {-step.dq[i], -step.ddq[i], -last.dq[i], -limits.lowestVelocity(i, last.q[i]),
          limits.arm.dq[i]};
}

// Above a shrinking limit, but with half of the excess removed in this tick or at full braking.
bool comesDown(const Directed& joint, double ddq_max) noexcept {
  const double excess = joint.last_dq - joint.limit;
  const double braking = std::min(0.5 * excess, ddq_max * kTick) * kBrakingShare;
  return joint.limit < joint.far_limit && joint.last_dq <= joint.far_limit && excess > 0.0 &&
         joint.dq <= joint.last_dq - braking;
}

// Brakes suddenly, but no harder than the limiter's law: jerk / acceleration times the distance to
// the limit. (Where the limit shrinks, the law may even exceed the acceleration.)
bool mustBrake(const Directed& joint, double ddq_max, double dddq_max) noexcept {
  const double hardest = dddq_max / ddq_max * (joint.limit - kClientMargin - joint.last_dq);
  const double tolerance = (1.0 - kBrakingShare) * std::abs(hardest) + 1e-9;
  return joint.ddq >= hardest - tolerance;
}

Directed againstChange(double change, const JointSample& step, const JointSample& last,
                       const MotionLimits& limits, std::size_t i) noexcept {
  return change < 0.0 ? upwards(step, last, limits, i) : downwards(step, last, limits, i);
}

bool positionsFail(const JointSample& step, const JointSample& last,
                   const MotionLimits& limits) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    // Beyond a limit, motion back is allowed.
    const double highest = std::max(limits.arm.q_max[i], last.q[i]);
    const double lowest = std::min(limits.arm.q_min[i], last.q[i]);
    if (!(step.q[i] <= highest && step.q[i] >= lowest)) {
      return true;
    }
  }
  return false;
}

bool velocitiesFail(const JointSample& step, const JointSample& last,
                    const MotionLimits& limits) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    for (const Directed& joint :
         {upwards(step, last, limits, i), downwards(step, last, limits, i)}) {
      if (!(joint.dq <= joint.limit) && !comesDown(joint, limits.arm.ddq[i])) {
        return true;
      }
    }
  }
  return false;
}

bool accelerationsFail(const JointSample& step, const JointSample& last,
                       const MotionLimits& limits) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    const Directed joint = againstChange(step.ddq[i], step, last, limits, i);
    const bool shrinks = joint.limit < joint.far_limit;
    if (!(std::abs(step.ddq[i]) <= limits.arm.ddq[i]) &&
        !(shrinks && mustBrake(joint, limits.arm.ddq[i], limits.arm.dddq[i]))) {
      return true;
    }
  }
  return false;
}

bool jerksFail(const JointSample& step, const JointSample& last, double factor,
               const MotionLimits& limits) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    if (!(std::abs(step.dddq[i]) <= limits.arm.dddq[i] * factor) &&
        !mustBrake(againstChange(step.dddq[i], step, last, limits, i), limits.arm.ddq[i],
                   limits.arm.dddq[i])) {
      return true;
    }
  }
  return false;
}

void differentiate(const JointSample& last, JointSample& step) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    step.ddq[i] = (step.dq[i] - last.dq[i]) / kTick;
    step.dddq[i] = (step.ddq[i] - last.ddq[i]) / kTick;
  }
}

}  // namespace

ErrorSet judge(const JointSample& step, const JointSample& last, const JointFlags& flags,
               const MotionLimits& limits) noexcept {
  ErrorSet errors = judgeJerk(step, last, flags, limits);
  errors.addIf(positionsFail(step, last, limits), flags.position);
  errors.addIf(velocitiesFail(step, last, limits), flags.velocity);
  errors.addIf(accelerationsFail(step, last, limits), flags.acceleration);
  return errors;
}

ErrorSet judgeJerk(const JointSample& step, const JointSample& last, const JointFlags& flags,
                   const MotionLimits& limits) noexcept {
  ErrorSet errors;
  errors.addIf(jerksFail(step, last, flags.jerk_factor, limits), flags.jerk);
  return errors;
}

JointSample stepToPositions(const JointSample& last, const std::array<double, 7>& q) noexcept {
  JointSample step;
  step.q = q;
  for (std::size_t i = 0; i < 7; i++) {
    step.dq[i] = (q[i] - last.q[i]) / kTick;
  }
  differentiate(last, step);
  return step;
}

JointSample stepByVelocities(const JointSample& last, const std::array<double, 7>& dq) noexcept {
  JointSample step;
  step.dq = dq;
  for (std::size_t i = 0; i < 7; i++) {
    step.q[i] = last.q[i] + dq[i] * kTick;
  }
  differentiate(last, step);
  return step;
}

JointSample stepByAcceleration(const JointSample& last) noexcept {
  JointSample step;
  step.ddq = last.ddq;
  for (std::size_t i = 0; i < 7; i++) {
    step.dq[i] = last.dq[i] + last.ddq[i] * kTick;
    step.q[i] = last.q[i] + step.dq[i] * kTick;
  }
  return step;
}

JointSample asEchoed(const JointSample& sample) noexcept {
  return {asEchoed(sample.q), asEchoed(sample.dq), asEchoed(sample.ddq), sample.dddq};
}

}  // namespace franka_sim
