// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/control_tools.h>
#include <franka/rate_limiting.h>
#include <franka_core/finite.h>
#include <franka_core/rotations.h>
#include <franka_core/transform.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "franka/nearest_rotation.h"

namespace franka {

namespace {

/// Bounds on the norm of a vector and of its derivatives.
struct Bounds {
  double velocity;
  double acceleration;
  double jerk;
};

template <std::size_t kSize>
void requireFinite(const std::array<double, kSize>& values) {
  if (!franka_core::allFinite(values)) {
    throw std::invalid_argument(
        "libfranka rate limiting: a commanded value is infinite or not a number.");
  }
}

double clampMagnitude(double value, double limit) {
  return std::max(std::min(value, limit), -limit);
}

using Joints = std::array<double, 7>;

template <typename Function>
Joints forEachJoint(Function function) {
  Joints values{};
  for (std::size_t i = 0; i < values.size(); i++) {
    values[i] = function(i);
  }
  return values;
}

/// Whether the argument at the position of libfranka 0.10's acceleration limit is the lower
/// velocity limit of later releases: negative, or kLimitEps beyond a joint's end.
bool isLowerVelocity(double max_acceleration) { return max_acceleration <= kLimitEps; }

/// Allowed velocities of one joint [rad/s].
struct VelocityRange {
  double lowest;
  double highest;
};

// Jerk limit first; then an acceleration small enough that braking within the jerk limit can still
// meet the velocity limits.
double limitVelocity(const VelocityRange& range, double max_acceleration, double max_jerk,
                     double velocity, double last_velocity, double last_acceleration) {
  const double jerk = ((velocity - last_velocity) / kDeltaT - last_acceleration) / kDeltaT;
  const double acceleration = last_acceleration + clampMagnitude(jerk, max_jerk) * kDeltaT;
  const double stiffness = max_jerk / max_acceleration;
  const double highest = std::min(stiffness * (range.highest - last_velocity), max_acceleration);
  const double lowest = std::max(stiffness * (range.lowest - last_velocity), -max_acceleration);
  return last_velocity + std::max(std::min(acceleration, highest), lowest) * kDeltaT;
}

// The same for a vector.
Eigen::Vector3d limitVelocity(const Bounds& bounds, const Eigen::Vector3d& velocity,
                              const Eigen::Vector3d& last_velocity,
                              const Eigen::Vector3d& last_acceleration) {
  const Eigen::Vector3d jerk = ((velocity - last_velocity) / kDeltaT - last_acceleration) / kDeltaT;
  Eigen::Vector3d acceleration = last_acceleration;
  const double jerk_norm = jerk.norm();
  if (jerk_norm > kNormEps) {
    acceleration += jerk / jerk_norm * std::min(jerk_norm, bounds.jerk) * kDeltaT;
  }
  const double acceleration_norm = acceleration.norm();
  if (!(acceleration_norm > kNormEps)) {
    return last_velocity;
  }
  const Eigen::Vector3d direction = acceleration / acceleration_norm;
  const double along = direction.dot(last_velocity);
  // The remaining speed in this direction within the sphere of allowed velocities. Outside of it
  // and moving past it the square is negative: then only braking is left.
  const double square =
      along * along - last_velocity.squaredNorm() + bounds.velocity * bounds.velocity;
  const double distance = -along + std::sqrt(std::max(square, 0.0));
  // Beyond the sphere the remaining speed is negative, and as an acceleration it could exceed the
  // limit.
  const double allowed =
      clampMagnitude(bounds.jerk / bounds.acceleration * distance, bounds.acceleration);
  return last_velocity + direction * std::min(acceleration_norm, allowed) * kDeltaT;
}

}  // namespace

std::array<double, 7> limitRate(const std::array<double, 7>& max_derivatives,
                                const std::array<double, 7>& commanded_values,
                                const std::array<double, 7>& last_commanded_values) {
  requireFinite(commanded_values);
  std::array<double, 7> limited{};
  for (std::size_t i = 0; i < 7; i++) {
    const double rate = (commanded_values[i] - last_commanded_values[i]) / kDeltaT;
    limited[i] = last_commanded_values[i] + clampMagnitude(rate, max_derivatives[i]) * kDeltaT;
  }
  return limited;
}

double limitRate(double max_velocity, double max_acceleration, double max_jerk,
                 double commanded_velocity, double last_commanded_velocity,
                 double last_commanded_acceleration) {
  requireFinite(std::array<double, 1>{commanded_velocity});
  return limitVelocity({-max_velocity, max_velocity}, max_acceleration, max_jerk,
                       commanded_velocity, last_commanded_velocity, last_commanded_acceleration);
}

double limitRate(double max_velocity, double max_acceleration, double max_jerk,
                 double commanded_position, double last_commanded_position,
                 double last_commanded_velocity, double last_commanded_acceleration) {
  if (isLowerVelocity(max_acceleration)) {
    // Actual meaning: upper and lower velocity, acceleration, jerk, velocity, and the last two.
    const double commanded_velocity = last_commanded_position;
    requireFinite(std::array<double, 1>{commanded_velocity});
    return limitVelocity({max_acceleration, max_velocity}, max_jerk, commanded_position,
                         commanded_velocity, last_commanded_velocity, last_commanded_acceleration);
  }
  return limitRate(max_velocity, -max_velocity, max_acceleration, max_jerk, commanded_position,
                   last_commanded_position, last_commanded_velocity, last_commanded_acceleration);
}

double limitRate(double upper_velocity, double lower_velocity, double max_acceleration,
                 double max_jerk, double commanded_position, double last_commanded_position,
                 double last_commanded_velocity, double last_commanded_acceleration) {
  requireFinite(std::array<double, 1>{commanded_position});
  return last_commanded_position +
         limitVelocity({lower_velocity, upper_velocity}, max_acceleration, max_jerk,
                       (commanded_position - last_commanded_position) / kDeltaT,
                       last_commanded_velocity, last_commanded_acceleration) *
             kDeltaT;
}

Joints limitRate(const Joints& max_velocity, const Joints& max_acceleration, const Joints& max_jerk,
                 const Joints& commanded_velocities, const Joints& last_commanded_velocities,
                 const Joints& last_commanded_accelerations) {
  return forEachJoint([&](std::size_t i) {
    return limitRate(max_velocity[i], max_acceleration[i], max_jerk[i], commanded_velocities[i],
                     last_commanded_velocities[i], last_commanded_accelerations[i]);
  });
}

Joints limitRate(const Joints& max_velocity, const Joints& max_acceleration, const Joints& max_jerk,
                 const Joints& commanded_positions, const Joints& last_commanded_positions,
                 const Joints& last_commanded_velocities,
                 const Joints& last_commanded_accelerations) {
  if (std::any_of(max_acceleration.begin(), max_acceleration.end(), isLowerVelocity)) {
    // Actual meaning: upper and lower velocity, acceleration, jerk, velocity, and the last two.
    const Joints& commanded_velocities = last_commanded_positions;
    requireFinite(commanded_velocities);
    return forEachJoint([&](std::size_t i) {
      return limitVelocity({max_acceleration[i], max_velocity[i]}, max_jerk[i],
                           commanded_positions[i], commanded_velocities[i],
                           last_commanded_velocities[i], last_commanded_accelerations[i]);
    });
  }
  return forEachJoint([&](std::size_t i) {
    return limitRate(max_velocity[i], max_acceleration[i], max_jerk[i], commanded_positions[i],
                     last_commanded_positions[i], last_commanded_velocities[i],
                     last_commanded_accelerations[i]);
  });
}

Joints limitRate(const Joints& upper_velocity, const Joints& lower_velocity,
                 const Joints& max_acceleration, const Joints& max_jerk,
                 const Joints& commanded_positions, const Joints& last_commanded_positions,
                 const Joints& last_commanded_velocities,
                 const Joints& last_commanded_accelerations) {
  return forEachJoint([&](std::size_t i) {
    return limitRate(upper_velocity[i], lower_velocity[i], max_acceleration[i], max_jerk[i],
                     commanded_positions[i], last_commanded_positions[i],
                     last_commanded_velocities[i], last_commanded_accelerations[i]);
  });
}

std::array<double, 6> limitRate(double max_translational_velocity,
                                double max_translational_acceleration,
                                double max_translational_jerk, double max_rotational_velocity,
                                double max_rotational_acceleration, double max_rotational_jerk,
                                const std::array<double, 6>& O_dP_EE_c,
                                const std::array<double, 6>& last_O_dP_EE_c,
                                const std::array<double, 6>& last_O_ddP_EE_c) {
  requireFinite(O_dP_EE_c);
  using Twist = Eigen::Matrix<double, 6, 1>;
  const Eigen::Map<const Twist> desired(O_dP_EE_c.data());
  const Eigen::Map<const Twist> last(last_O_dP_EE_c.data());
  const Eigen::Map<const Twist> last_acceleration(last_O_ddP_EE_c.data());
  std::array<double, 6> limited{};
  Eigen::Map<Twist> result(limited.data());
  result.head<3>() = limitVelocity(
      {max_translational_velocity, max_translational_acceleration, max_translational_jerk},
      desired.head<3>(), last.head<3>(), last_acceleration.head<3>());
  result.tail<3>() =
      limitVelocity({max_rotational_velocity, max_rotational_acceleration, max_rotational_jerk},
                    desired.tail<3>(), last.tail<3>(), last_acceleration.tail<3>());
  return limited;
}

std::array<double, 16> limitRate(double max_translational_velocity,
                                 double max_translational_acceleration,
                                 double max_translational_jerk, double max_rotational_velocity,
                                 double max_rotational_acceleration, double max_rotational_jerk,
                                 const std::array<double, 16>& O_T_EE_c,
                                 const std::array<double, 16>& last_O_T_EE_c,
                                 const std::array<double, 6>& last_O_dP_EE_c,
                                 const std::array<double, 6>& last_O_ddP_EE_c) {
  requireFinite(O_T_EE_c);
  if (!isHomogeneousTransformation(O_T_EE_c)) {
    throw std::invalid_argument(
        "libfranka rate limiting: the commanded pose is not a homogeneous transformation: " +
        franka_core::transformFault(O_T_EE_c) + ".");
  }
  const Eigen::Map<const Eigen::Matrix4d> desired(O_T_EE_c.data());
  const Eigen::Map<const Eigen::Matrix4d> last(last_O_T_EE_c.data());
  const Eigen::Matrix3d last_rotation = nearestRotation(last_O_T_EE_c);

  std::array<double, 6> twist{};
  Eigen::Map<Eigen::Vector3d> linear(twist.data());
  Eigen::Map<Eigen::Vector3d> angular(twist.data() + 3);
  linear = (desired.topRightCorner<3, 1>() - last.topRightCorner<3, 1>()) / kDeltaT;
  angular = franka_core::vectorOf(
                Eigen::Matrix3d(nearestRotation(O_T_EE_c) * last_rotation.transpose())) /
            kDeltaT;
  twist =
      limitRate(max_translational_velocity, max_translational_acceleration, max_translational_jerk,
                kFactorCartesianRotationPoseInterface * max_rotational_velocity,
                kFactorCartesianRotationPoseInterface * max_rotational_acceleration,
                kFactorCartesianRotationPoseInterface * max_rotational_jerk, twist, last_O_dP_EE_c,
                last_O_ddP_EE_c);

  std::array<double, 16> limited = last_O_T_EE_c;
  Eigen::Map<Eigen::Matrix4d> result(limited.data());
  result.topRightCorner<3, 1>() += linear * kDeltaT;
  result.topLeftCorner<3, 3>() = franka_core::rotationFrom(angular * kDeltaT) * last_rotation;
  return limited;
}

}  // namespace franka
