// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/arm_rate_limits.h"

#include <franka/rate_limiting.h>
#include <franka_core/fci/protocol.h>
#include <franka_core/joint_limiter.h>
#include <franka_core/numbers.h>
#include <tinyxml2.h>

#include <optional>

namespace franka {

namespace {

using Joints = ArmRateLimits::Joints;

// An FR3 has no margin for lost packets (kTolNumberPacketsLost of its client is 0).
constexpr double withoutPackets(double velocity) { return velocity - kLimitEps; }

franka_core::DerivativeLimits withMargin(const franka_core::DerivativeLimits& limits) {
  return {withoutPackets(limits.velocity), limits.acceleration - kLimitEps,
          limits.jerk - kLimitEps};
}

ArmRateLimits pandaLimits() {
  ArmRateLimits limits{};
  limits.torque_rate = kMaxTorqueRate;
  limits.joint_acceleration = kMaxJointAcceleration;
  limits.joint_jerk = kMaxJointJerk;
  limits.joint_velocity = kMaxJointVelocity;
  limits.translation = {kMaxTranslationalVelocity, kMaxTranslationalAcceleration,
                        kMaxTranslationalJerk};
  limits.rotation = {kMaxRotationalVelocity, kMaxRotationalAcceleration, kMaxRotationalJerk};
  limits.elbow = {kMaxElbowVelocity, kMaxElbowAcceleration, kMaxElbowJerk};
  return limits;
}

ArmRateLimits fr3Limits(const franka_core::PositionVelocityLimits& velocities) {
  const franka_core::ArmLimits& arm = franka_core::kFr3Limits;
  ArmRateLimits limits{};
  limits.torque_rate = rate_limiting_detail::withMargin(arm.dtau);
  limits.joint_acceleration = rate_limiting_detail::withMargin(arm.ddq);
  limits.joint_jerk = rate_limiting_detail::withMargin(arm.dddq);
  limits.position_velocity = velocities;
  limits.velocity_margin = kLimitEps;
  limits.translation = withMargin(arm.translation);
  limits.rotation = withMargin(arm.rotation);
  limits.elbow = withMargin(arm.elbow);
  return limits;
}

const tinyxml2::XMLElement* findJoint(const tinyxml2::XMLElement& robot, const std::string& name) {
  const tinyxml2::XMLElement* similar = nullptr;
  for (const auto* joint = robot.FirstChildElement("joint"); joint != nullptr;
       joint = joint->NextSiblingElement("joint")) {
    const char* text = joint->Attribute("name");
    const std::string its_name = text != nullptr ? text : "";
    if (its_name == name) {
      return joint;
    }
    if (similar == nullptr && its_name.find(name) != std::string::npos) {
      similar = joint;
    }
  }
  return similar;
}

bool readAttribute(const tinyxml2::XMLElement* element, const char* name, double& value) {
  const char* text = element != nullptr ? element->Attribute(name) : nullptr;
  const std::optional<double> number = franka_core::readNumber(text != nullptr ? text : "");
  value = number.value_or(value);
  return number.has_value();
}

}  // namespace

Joints ArmRateLimits::upperJointVelocity(const Joints& q) const noexcept {
  Joints limits = joint_velocity;
  for (std::size_t i = 0; position_velocity && i < 7; i++) {
    limits[i] = franka_core::upperVelocityLimit(*position_velocity, i, q[i]) - velocity_margin;
  }
  return limits;
}

Joints ArmRateLimits::lowerJointVelocity(const Joints& q) const noexcept {
  Joints limits{};
  for (std::size_t i = 0; i < 7; i++) {
    limits[i] = position_velocity
                    ? franka_core::lowerVelocityLimit(*position_velocity, i, q[i]) + velocity_margin
                    : -joint_velocity[i];
  }
  return limits;
}

Joints ArmRateLimits::limitVelocities(const Joints& q, const Joints& velocities,
                                      const Joints& last_velocities,
                                      const Joints& last_accelerations) const noexcept {
  franka_core::JointVelocityRange range = {lowerJointVelocity(q), upperJointVelocity(q)};
  if (position_velocity) {
    range = franka_core::rangeAt(franka_core::followable(*position_velocity, joint_acceleration,
                                                         joint_jerk, velocity_margin),
                                 q);
  }
  return franka_core::limitVelocities(range, joint_acceleration, joint_jerk, velocities,
                                      last_velocities, last_accelerations, kDeltaT);
}

Joints ArmRateLimits::limitPositions(const Joints& positions, const Joints& last_positions,
                                     const Joints& last_velocities,
                                     const Joints& last_accelerations) const noexcept {
  Joints velocities{};
  for (std::size_t i = 0; i < 7; i++) {
    velocities[i] = (positions[i] - last_positions[i]) / kDeltaT;
  }
  Joints limited = limitVelocities(last_positions, velocities, last_velocities, last_accelerations);
  for (std::size_t i = 0; i < 7; i++) {
    limited[i] = last_positions[i] + limited[i] * kDeltaT;
  }
  return limited;
}

ArmRateLimits rateLimitsOfProtocol(std::uint16_t version) {
  if (franka_core::fci::isPandaVersion(version)) {
    return pandaLimits();
  }
  return fr3Limits(franka_core::fr3VelocityLimitsOfProtocol(version));
}

std::optional<franka_core::PositionVelocityLimits> velocityLimitsFromUrdf(const std::string& urdf) {
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) {
    return std::nullopt;
  }
  const tinyxml2::XMLElement* robot = document.FirstChildElement("robot");
  franka_core::PositionVelocityLimits limits{};
  for (std::size_t i = 0; robot != nullptr && i < 7; i++) {
    const auto* joint = findJoint(*robot, "joint" + std::to_string(i + 1));
    const auto* limit = joint != nullptr ? joint->FirstChildElement("limit") : nullptr;
    const auto* by_position =
        joint != nullptr ? joint->FirstChildElement("position_based_velocity_limits") : nullptr;
    if (!readAttribute(limit, "lower", limits.q_min[i]) ||
        !readAttribute(limit, "upper", limits.q_max[i]) ||
        !readAttribute(limit, "velocity", limits.velocity[i]) ||
        !readAttribute(by_position, "velocity_offset", limits.offset[i]) ||
        !readAttribute(by_position, "deceleration_limit", limits.deceleration[i])) {
      return std::nullopt;
    }
    limits.deceleration[i] *= 2.0;  // the table holds the factor under the square root
  }
  return robot != nullptr ? std::make_optional(limits) : std::nullopt;
}

}  // namespace franka
