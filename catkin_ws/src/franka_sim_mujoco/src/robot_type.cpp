// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/limits.h>
#include <franka_sim_mujoco/robot_type.h>

#include <array>
#include <cmath>

namespace franka_sim_mujoco {

namespace {

constexpr char kPanda[] = "panda", kFr3[] = "fr3";
constexpr double kTolerance = 1e-3;  ///< [rad], [rad/s]: tables have four digits or less

struct JointLimits {
  std::array<double, 7> lower, upper, velocity;  ///< [rad], [rad], [rad/s]
};

/// Empty if a joint or its limits are missing.
std::optional<JointLimits> limitsIn(const urdf::Model& urdf, const std::string& arm_id) {
  JointLimits limits{};
  for (std::size_t i = 0; i < 7; ++i) {
    const auto joint = urdf.getJoint(arm_id + "_joint" + std::to_string(i + 1));
    if (!joint || !joint->limits || joint->type != urdf::Joint::REVOLUTE) {
      return std::nullopt;
    }
    limits.lower[i] = joint->limits->lower;
    limits.upper[i] = joint->limits->upper;
    limits.velocity[i] = joint->limits->velocity;
  }
  return limits;
}

bool reaches(const franka_core::ArmLimits& arm, const JointLimits& limits) {
  for (std::size_t i = 0; i < 7; ++i) {
    if (limits.lower[i] < arm.q_min[i] - kTolerance ||
        limits.upper[i] > arm.q_max[i] + kTolerance) {
      return false;
    }
  }
  return true;
}

bool equal(const std::array<double, 7>& a, const std::array<double, 7>& b) {
  for (std::size_t i = 0; i < 7; ++i) {
    if (!(std::abs(a[i] - b[i]) < kTolerance)) {
      return false;
    }
  }
  return true;
}

/// Empty for both or neither.
std::optional<std::string> theOne(bool panda, bool fr3) {
  return panda == fr3 ? std::nullopt : std::optional<std::string>(panda ? kPanda : kFr3);
}

/// Empty if the limits fit both or neither.
std::optional<RobotType> detectByLimits(const urdf::Model& urdf, const std::string& arm_id) {
  const std::optional<JointLimits> limits = limitsIn(urdf, arm_id);
  if (!limits) {
    return std::nullopt;
  }
  using namespace franka_core;
  const std::string of_joints = " that the URDF allows " + arm_id + "_joint1 to 7 are those of one";
  if (const auto type = theOne(reaches(kFerLimits, *limits), reaches(kFr3Limits, *limits))) {
    return RobotType{*type, "the positions" + of_joints, ""};
  }
  const bool panda = equal(limits->velocity, kFerLimits.dq);
  const bool fr3 =
      equal(limits->velocity, kFr3Limits.dq) || equal(limits->velocity, kFr3Limits.rate_limiter_dq);
  if (const auto type = theOne(panda, fr3)) {
    return RobotType{*type, "the velocities" + of_joints, ""};
  }
  return std::nullopt;
}

}  // namespace

bool isRobotType(const std::string& name) { return name == kPanda || name == kFr3; }

RobotType determineRobotType(const std::optional<std::string>& configured, const urdf::Model& urdf,
                             const std::string& arm_id) {
  const std::optional<RobotType> detected = detectByLimits(urdf, arm_id);
  if (configured) {
    const bool other = detected && detected->name != *configured;
    return {*configured, "it was requested",
            other ? "it looks like " + detected->name + ": " + detected->why : ""};
  }
  if (detected) {
    return *detected;
  }
  return {
      urdf.getName() == kFr3 ? kFr3 : kPanda,
      "the joint limits of the URDF fit both or neither, and its name is '" + urdf.getName() + "'",
      ""};
}

}  // namespace franka_sim_mujoco
