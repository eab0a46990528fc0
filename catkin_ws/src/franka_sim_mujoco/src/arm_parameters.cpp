// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "arm_parameters.h"

#include <franka_core/limits.h>
#include <franka_core/numbers.h>
#include <franka_core/typed_transform.h>
#include <franka_hw/robot_mismatch.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_gravity.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/protocol_range.h>
#include <franka_sim/serve/sim_robot.h>
#include <ros/console.h>
#include <ros/package.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "param_reader.h"

namespace franka_sim_mujoco {

namespace {

void readTransform(const ros::NodeHandle& node, const std::string& name,
                   std::array<double, 16>& transform) {
  readArray(node, name, transform);
  const franka_core::TypedTransform typed = franka_core::readTypedTransform(transform);
  transform = typed.matrix;
  const std::string fault = typed.fault.empty() ? franka_sim::frameFault(transform) : typed.fault;
  if (!fault.empty()) {
    throw std::invalid_argument(
        "The parameter " + node.resolveName(name) +
        " is not a column-major 4x4 transform to a frame on the arm: " + fault + ".");
  }
  if (!typed.warning.empty()) {
    ROS_WARN_STREAM_NAMED("franka_hw_sim", "The parameter " << node.resolveName(name) << ": "
                                                            << typed.warning << ".");
  }
}

void readPayload(const ros::NodeHandle& node, const std::string& mass, const std::string& com,
                 const std::string& inertia, franka_core::Payload& payload) {
  payload.mass = readNumber(node, mass).value_or(payload.mass);
  readArray(node, com, payload.com);
  readArray(node, inertia, payload.inertia);
  const std::string fault = franka_sim::payloadFault(payload);
  if (!fault.empty()) {
    throw std::invalid_argument("The parameters " + node.resolveName(mass) + ", " + com + " and " +
                                inertia + " are not those of a body. " + fault);
  }
}

void readThresholds(const ros::NodeHandle& node, const std::string& phase,
                    franka_sim::CollisionThresholds& thresholds) {
  readArray(node, "collision_config/lower_torque_thresholds_" + phase, thresholds.lower_torque);
  readArray(node, "collision_config/upper_torque_thresholds_" + phase, thresholds.upper_torque);
  readArray(node, "collision_config/lower_force_thresholds_" + phase, thresholds.lower_force);
  readArray(node, "collision_config/upper_force_thresholds_" + phase, thresholds.upper_force);
  const std::string fault = checkThresholds(thresholds);
  if (!fault.empty()) {
    throw std::invalid_argument("The parameters " + node.resolveName("collision_config") + "/*_" +
                                phase + " are wrong: " + fault);
  }
  const std::string remark = thresholdRemark(thresholds);
  if (!remark.empty()) {
    ROS_WARN_STREAM_NAMED("franka_hw_sim", "The parameters " << node.resolveName("collision_config")
                                                             << "/*_" << phase << ": " << remark);
  }
}

template <std::size_t N>
std::string checkPair(const std::array<double, N>& lower, const std::array<double, N>& upper,
                      const std::string& what) {
  for (std::size_t i = 0; i < N; ++i) {
    const std::string which = what + " threshold " + std::to_string(i + 1);
    if (!std::isfinite(lower[i]) || !std::isfinite(upper[i]) || lower[i] < 0.0 || upper[i] < 0.0) {
      return "The " + which + " must be a finite number that is not negative.";
    }
  }
  return "";
}

template <std::size_t N>
std::string pairRemark(const std::array<double, N>& lower, const std::array<double, N>& upper,
                       const std::string& what) {
  for (std::size_t i = 0; i < N; ++i) {
    if (lower[i] > upper[i]) {
      return "The lower " + what + " threshold " + std::to_string(i + 1) + " (" +
             franka_core::numberText(lower[i]) + ") is above the upper one (" +
             franka_core::numberText(upper[i]) + "): collisions begin before contacts.";
    }
  }
  return "";
}

/// The world's gravity in the axes of the arm's base [m/s^2]. @param base the body of that name
std::array<double, 3> gravityInBase(const franka_sim::World& world, const std::string& base) {
  const std::array<double, 3> g = gravity(world);
  const std::array<double, 4> q = bodyPose(world, base).orientation;
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {
      (1 - 2 * (y * y + z * z)) * g[0] + 2 * (x * y + w * z) * g[1] + 2 * (x * z - w * y) * g[2],
      2 * (x * y - w * z) * g[0] + (1 - 2 * (x * x + z * z)) * g[1] + 2 * (y * z + w * x) * g[2],
      2 * (x * z + w * y) * g[0] + 2 * (y * z - w * x) * g[1] + (1 - 2 * (x * x + y * y)) * g[2]};
}

}  // namespace

std::string checkThresholds(const franka_sim::CollisionThresholds& thresholds) {
  const std::string fault = checkPair(thresholds.lower_torque, thresholds.upper_torque, "torque");
  return fault.empty() ? checkPair(thresholds.lower_force, thresholds.upper_force, "force") : fault;
}

std::string thresholdRemark(const franka_sim::CollisionThresholds& thresholds) {
  const std::string remark = pairRemark(thresholds.lower_torque, thresholds.upper_torque, "torque");
  return remark.empty() ? pairRemark(thresholds.lower_force, thresholds.upper_force, "force")
                        : remark;
}

std::string readArmId(const ros::NodeHandle& node, const std::string& robot_namespace,
                      const std::string& robot_name) {
  std::string from_namespace = robot_namespace;
  from_namespace.erase(std::remove(from_namespace.begin(), from_namespace.end(), '/'),
                       from_namespace.end());
  const std::string fallback = from_namespace.empty() ? robot_name : from_namespace;
  const std::string arm_id = readString(node, "arm_id").value_or(fallback);
  if (arm_id.empty()) {
    throw std::invalid_argument("The parameter " + node.resolveName("arm_id") +
                                " is empty; it must be the prefix of the arm's joint names.");
  }
  return arm_id;
}

std::array<double, 7> readJointStiffness(const ros::NodeHandle& node, const std::string& arm_id,
                                         const std::array<double, 7>& fallback) {
  std::array<double, 7> stiffness = fallback;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const std::string name =
        "motion_generators/position/gains/" + arm_id + "_joint" + std::to_string(i + 1) + "/p";
    stiffness[i] = readNumber(node, name).value_or(stiffness[i]);
  }
  if (!franka_sim::isJointStiffness(stiffness)) {
    throw std::invalid_argument(
        "The parameters " + node.resolveName("motion_generators/position/gains") + "/" + arm_id +
        "_joint<1 to 7>/p are stiffnesses; they must lie between 0 and 14250 Nm/rad.");
  }
  return stiffness;
}

franka_sim::RobotPhysics readPhysics(const ros::NodeHandle& node, const std::string& robot_type,
                                     const char* profile) {
  std::string found;
  const std::string name = node.searchParam("realism", found) ? found : "realism";
  const franka_sim::Realism realism =
      franka_sim::readRealism(readString(node, name).value_or(""), profile);
  const std::string folder = ros::package::getPath("franka_description");
  if (folder.empty()) {
    ROS_WARN_NAMED("franka_sim_mujoco",
                   "The package franka_description was not found: joints get the default physics.");
    return franka_sim::RobotPhysics{};
  }
  return franka_sim::readRobotPhysics(folder + "/config/physics.yaml", robot_type, realism);
}

std::string gainsWithoutEffect(const ros::NodeHandle& node, const std::string& arm_id) {
  std::string found;
  const auto note = [&](const std::string& name) {
    found += (found.empty() ? "" : ", ") + node.resolveName("motion_generators") + "/" + name;
  };
  if (node.hasParam("motion_generators/velocity/gains")) {
    note("velocity/gains");
  }
  for (const std::string gain : {"i", "d"}) {
    bool present = false;
    for (int joint = 1; joint <= 7 && !present; ++joint) {
      present = readNumber(node, "motion_generators/position/gains/" + arm_id + "_joint" +
                                     std::to_string(joint) + "/" + gain)
                    .value_or(0.0) != 0.0;
    }
    if (present) {
      note("position/gains/*/" + gain);
    }
  }
  return found;
}

franka_sim::ControlUnitParameters readArmParameters(const ros::NodeHandle& node,
                                                    const RobotHandle& robot,
                                                    const SimulatedArm& arm) {
  const std::string& arm_id = arm.arm_id;
  franka_sim::ControlUnitParameters parameters{franka_core::ArmModel::fromUrdf(robot.urdf, arm_id)};
  parameters.protocol_version = franka_sim::protocolsOf(arm.type).newest;
  robot.between_ticks([&] {
    parameters.has_hand = robot.world->hasHand(robot.name, arm_id);
    parameters.gravity = gravityInBase(*robot.world, arm_id + "_link0");
  });
  franka_sim::applyPhysics(arm.physics, parameters);
  readArray(node, "gravity_vector", parameters.gravity);

  // With all three set, a hand without inertial in the URDF is not an error.
  const bool explicit_end_effector =
      node.hasParam("m_ee") && node.hasParam("I_ee") && node.hasParam("F_x_Cee");
  if (!explicit_end_effector) {
    parameters.end_effector = franka_core::endEffectorFromUrdf(robot.urdf, arm_id);
  }
  readPayload(node, "m_ee", "F_x_Cee", "I_ee", parameters.end_effector);
  readPayload(node, "m_load", "F_x_Cload", "I_load", parameters.load);

  const auto described = franka_core::nominalEndEffectorFromUrdf(robot.urdf, arm_id);
  parameters.F_T_NE = described.value_or(franka_core::kIdentityTransform);
  readTransform(node, "F_T_NE", parameters.F_T_NE);
  const std::string mismatch = franka_hw::endEffectorMismatch(described, parameters.F_T_NE, arm_id);
  if (!mismatch.empty()) {
    ROS_WARN_STREAM_NAMED("franka_hw_sim",
                          "'" << arm_id << "': " << mismatch << " Delete the parameter "
                              << node.resolveName("F_T_NE") << " to follow the description.");
  }
  readTransform(node, "NE_T_EE", parameters.NE_T_EE);
  readTransform(node, "EE_T_K", parameters.EE_T_K);

  readThresholds(node, "nominal", parameters.nominal);
  parameters.acceleration = parameters.nominal;
  readThresholds(node, "acceleration", parameters.acceleration);
  return parameters;
}

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
