// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/joint_velocity_limits.h>
#include <franka/rate_limiting.h>

#include <stdexcept>

#include "franka/arm_rate_limits.h"

namespace franka {

JointVelocityLimitsConfig::JointVelocityLimitsConfig(const std::string& urdf) {
  parseFromURDF(urdf);
}

void JointVelocityLimitsConfig::parseFromURDF(const std::string& urdf) {
  const auto limits = velocityLimitsFromUrdf(urdf);
  if (!limits) {
    throw std::runtime_error(
        "libfranka: The description (URDF) states no joint velocity limits: each of joint1 to "
        "joint7 needs <limit lower upper velocity> and <position_based_velocity_limits "
        "velocity_offset deceleration_limit>. The description that an FR3 with system 5.9.0 or "
        "later sends has them (Robot::getRobotModel).");
  }
  limits_ = *limits;
}

std::array<double, 7> JointVelocityLimitsConfig::getUpperJointVelocityLimits(
    const std::array<double, 7>& joint_positions) const noexcept {
  return rate_limiting_detail::upperJointVelocities(limits_, joint_positions);
}

std::array<double, 7> JointVelocityLimitsConfig::getLowerJointVelocityLimits(
    const std::array<double, 7>& joint_positions) const noexcept {
  return rate_limiting_detail::lowerJointVelocities(limits_, joint_positions);
}

}  // namespace franka
