// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/limits/motion_checks.h"

#include <franka_sim/robot/plant.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

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

Directed upwards(const JointSample& step, const JointSample& last,
                 const franka_core::MotionLimits& limits, std::size_t i) noexcept {
  return {step.dq[i], step.ddq[i], last.dq[i], limits.highestVelocity(i, last.q[i]),
          limits.arm.dq[i]};
}

Directed downwards(const JointSample& step, const JointSample& last,
                   const franka_core::MotionLimits& limits, std::size_t i) noexcept {
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
                       const franka_core::MotionLimits& limits, std::size_t i) noexcept {
  return change < 0.0 ? upwards(step, last, limits, i) : downwards(step, last, limits, i);
}

bool positionsFail(const JointSample& step, const JointSample& last,
                   const franka_core::MotionLimits& limits) noexcept {
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
                    const franka_core::MotionLimits& limits) noexcept {
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
                       const franka_core::MotionLimits& limits) noexcept {
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
               const franka_core::MotionLimits& limits) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    if (!(std::abs(step.dddq[i]) <= limits.arm.dddq[i] * factor) &&
        !mustBrake(againstChange(step.dddq[i], step, last, limits, i), limits.arm.ddq[i],
                   limits.arm.dddq[i])) {
      return true;
    }
  }
  return false;
}

}  // namespace

ErrorSet checkStep(const JointSample& step, const JointSample& last, const JointFlags& flags,
                   const franka_core::MotionLimits& limits) noexcept {
  ErrorSet errors = checkJerk(step, last, flags, limits);
  errors.addIf(positionsFail(step, last, limits), flags.position);
  errors.addIf(velocitiesFail(step, last, limits), flags.velocity);
  errors.addIf(accelerationsFail(step, last, limits), flags.acceleration);
  return errors;
}

ErrorSet checkJerk(const JointSample& step, const JointSample& last, const JointFlags& flags,
                   const franka_core::MotionLimits& limits) noexcept {
  ErrorSet errors;
  errors.addIf(jerksFail(step, last, flags.jerk_factor, limits), flags.jerk);
  return errors;
}

JointSample asEchoed(const JointSample& sample) noexcept {
  return {asEchoed(sample.q), asEchoed(sample.dq), asEchoed(sample.ddq), sample.dddq};
}

using franka_core::RobotError;

namespace {

using Eigen::Vector3d;
using Derivative = std::array<double, 6>;

// A client's rate limiter shortens an acceleration that would leave the sphere of allowed speeds,
// if necessary in one tick and beyond the jerk limit. A rate-limited client is never aborted, so
// this is accepted here. Tolerances for the limiter's margins (lost packets, 99 % of the rotation
// limits):
constexpr double kBrakingTime = 0.005;  // [s]: acceleration times this is kept free
constexpr double kSpeedShare = 0.985;
constexpr double kElbowMargin = 1e-3;  // [rad/s]
// Floats slightly skew a rotation, which turns the direction of a small acceleration.
constexpr double kAccelerationNoise = 5e-4;  // [m/s^2], [rad/s^2]
constexpr double kMaxDirectionNoise = 0.01;  // [rad]

Vector3d part(const Derivative& values, std::size_t first) noexcept {
  return {values[first], values[first + 1], values[first + 2]};
}

// The speed along a direction at which the sphere of radius highest ends.
double speedLeft(const Vector3d& direction, const Vector3d& velocity, double highest) noexcept {
  const double along = direction.dot(velocity);
  const double square = along * along - velocity.squaredNorm() + highest * highest;
  return std::sqrt(std::max(square, 0.0)) - along;
}

// Distance between a point and the ray along a direction that starts at a length.
double distanceToRay(const Vector3d& direction, double from, const Vector3d& point) noexcept {
  const double nearest = std::max(from, direction.dot(point));
  return (nearest * direction - point).norm();
}

// Whether the acceleration is one within the jerk limit, shortened by the speed limit; beyond the
// sphere the limiter reverses it.
bool isShortened(const CartesianSample& step, const CartesianSample& last, std::size_t first,
                 const franka_core::DerivativeLimits& limits) noexcept {
  const Vector3d acceleration = part(step.acceleration, first);
  const Vector3d before = part(last.acceleration, first);
  const Vector3d velocity = part(last.twist, first);
  const double size = acceleration.norm();
  const double highest = kSpeedShare * (limits.velocity - kBrakingTime * limits.acceleration);
  if (!(size > 0.0)) {
    return velocity.norm() >= highest;
  }
  const Vector3d direction = acceleration / size;
  const double gain = limits.jerk / limits.acceleration;
  const double reach = limits.jerk * kTick;
  const double noise = std::min(kAccelerationNoise / size, kMaxDirectionNoise) * limits.velocity;
  const double least = gain * (speedLeft(direction, velocity, highest) - noise) * kBrakingShare;
  const double hardest = gain * (noise - speedLeft(-direction, velocity, highest)) / kBrakingShare;
  return (size >= least && distanceToRay(direction, size, before) <= reach) ||
         (size <= hardest && distanceToRay(-direction, 0.0, before) <= reach);
}

bool positionFails(const ElbowSample& step, const ElbowSample& last,
                   const franka_core::MotionLimits& limits) noexcept {
  return !(step.q3 <= std::max(limits.arm.q_max[2], last.q3) &&
           step.q3 >= std::min(limits.arm.q_min[2], last.q3));
}

template <typename Bound>
bool anyFails(const Derivative& values, const franka_core::MotionLimits& limits,
              Bound bound) noexcept {
  return !(part(values, 0).norm() <= bound(limits.arm.translation)) ||
         !(part(values, 3).norm() <= bound(limits.arm.rotation));
}

bool jerkFails(const CartesianSample& step, const CartesianSample& last, std::size_t first,
               const franka_core::DerivativeLimits& limits) noexcept {
  return !(part(step.jerk, first).norm() <= limits.jerk) && !isShortened(step, last, first, limits);
}

// The same for the elbow: it may brake as hard as the limiter's law demands near the limiter's
// speed.
bool elbowBrakes(const ElbowSample& step, const ElbowSample& last,
                 const franka_core::DerivativeLimits& limiter) noexcept {
  const double towards = step.dddq3 < 0.0 ? 1.0 : -1.0;
  const double speed_left = limiter.velocity - kElbowMargin - towards * last.dq3;
  const double hardest = limiter.jerk / limiter.acceleration * speed_left;
  return towards * step.ddq3 >= hardest - (1.0 - kBrakingShare) * std::abs(hardest);
}

bool elbowJerks(const ElbowSample& step, const ElbowSample& last,
                const franka_core::MotionLimits& limits) noexcept {
  return !(std::abs(step.dddq3) <= limits.arm.elbow.jerk) &&
         !elbowBrakes(step, last, limits.arm.elbow);
}

bool elbowFails(const ElbowSample& step, const ElbowSample& last,
                const franka_core::MotionLimits& limits) noexcept {
  const franka_core::DerivativeLimits elbow = limits.elbow();
  return positionFails(step, last, limits) || !(std::abs(step.dq3) <= elbow.velocity) ||
         !(std::abs(step.ddq3) <= elbow.acceleration) || elbowJerks(step, last, limits);
}

}  // namespace

ErrorSet checkStep(const CartesianSample& step, const CartesianSample& last,
                   const franka_core::MotionLimits& limits) noexcept {
  using Bounds = franka_core::DerivativeLimits;
  ErrorSet errors;
  errors.addIf(elbowFails(step.elbow, last.elbow, limits),
               RobotError::kCartesianMotionGeneratorElbowLimitViolation);
  errors.addIf(anyFails(step.twist, limits, [](const Bounds& b) { return b.velocity; }),
               RobotError::kCartesianMotionGeneratorVelocityLimitsViolation);
  errors.addIf(anyFails(step.acceleration, limits, [](const Bounds& b) { return b.acceleration; }),
               RobotError::kCartesianMotionGeneratorVelocityDiscontinuity);
  errors.addIf(jerkFails(step, last, 0, limits.arm.translation) ||
                   jerkFails(step, last, 3, limits.arm.rotation),
               RobotError::kCartesianMotionGeneratorAccelerationDiscontinuity);
  return errors;
}

CartesianSample asEchoed(const CartesianSample& sample) noexcept {
  CartesianSample seen = sample;
  seen.pose = asEchoed(sample.pose);
  seen.twist = asEchoed(sample.twist);
  seen.acceleration = asEchoed(sample.acceleration);
  seen.elbow.q3 = asEchoed(sample.elbow.q3);
  seen.elbow.dq3 = asEchoed(sample.elbow.dq3);
  seen.elbow.ddq3 = asEchoed(sample.elbow.ddq3);
  return seen;
}

}  // namespace franka_sim
