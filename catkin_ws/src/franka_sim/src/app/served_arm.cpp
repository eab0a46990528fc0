// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "served_arm.h"

#include <franka_core/limits.h>
#include <franka_sim/fci/serving.h>
#include <franka_sim/physics/physics_config.h>

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "files.h"

namespace franka_sim {
namespace {

constexpr std::array<double, 7> kReady{0, -M_PI_4, 0, -3 * M_PI_4, 0, M_PI_2, M_PI_4};
constexpr double kFingersAtStart = 0.001;  // [m] each

// Flange to the hand's nominal end effector: turned by -45 deg about z, 0.1034 m along it
// (protocol 8.3).
constexpr std::array<double, 16> kHandF_T_NE{
    M_SQRT1_2, -M_SQRT1_2, 0, 0, M_SQRT1_2, M_SQRT1_2, 0, 0, 0, 0, 1, 0, 0, 0, 0.1034, 1};

// The descriptions that come along name all links and joints after their robot.
std::string withPrefix(std::string urdf, const std::string& robot, const std::string& arm_id) {
  const std::string old_name = "\"" + robot + "_";
  const std::string new_name = "\"" + arm_id + "_";
  for (std::size_t at = urdf.find(old_name); at != std::string::npos;
       at = urdf.find(old_name, at + new_name.size())) {
    urdf.replace(at, old_name.size(), new_name);
  }
  return urdf;
}

std::string robotText(const ArmOptions& options) {
  if (!options.urdf.empty()) {
    return readFile(options.urdf);
  }
  const std::string name = "robots/" + options.robot + ".urdf";
  const std::string file = packageFile("franka_sim", name);
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find its file " + name +
                             "; give a robot description with --urdf.");
  }
  return withPrefix(readFile(file), options.robot, options.arm_id);
}

JointPhysics jointPhysics(const ArmOptions& options) {
  const std::string file = packageFile("franka_description", "config/physics.yaml");
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find config/physics.yaml of franka_description.");
  }
  return readJointPhysics(file, options.robot, options.friction);
}

RobotDescription describeRobot(const ArmOptions& options, const std::string& urdf,
                               const JointPhysics& physics, bool hand,
                               const std::array<double, 7>& q) {
  RobotDescription robot;
  robot.name = options.arm_id;
  robot.urdf = urdf;
  robot.resolve = resolveUri;
  robot.base.position = options.base;
  robot.base.orientation = {std::cos(0.5 * options.yaw), 0, 0, std::sin(0.5 * options.yaw)};
  for (std::size_t i = 0; i < 7; i++) {
    robot.initial_positions[options.arm_id + "_joint" + std::to_string(i + 1)] = q[i];
  }
  if (hand) {
    for (const char* finger : {"_finger_joint1", "_finger_joint2"}) {
      robot.initial_positions[options.arm_id + finger] = kFingersAtStart;
    }
  }
  applyJointPhysics(physics, options.arm_id, robot);
  return robot;
}

fci::ProtocolRange protocolsOf(const ArmOptions& options) {
  return options.protocol != 0 ? fci::ProtocolRange{options.protocol, options.protocol}
                               : fci::protocolsOf(options.robot);
}

ControlUnitParameters unitParameters(const ArmOptions& options, const std::string& urdf,
                                     const JointPhysics& physics, bool hand) {
  ControlUnitParameters parameters{franka_core::ArmModel::fromUrdf(urdf, options.arm_id)};
  parameters.rotor_inertia = physics.rotor_inertia;
  parameters.coulomb_friction = physics.coulomb_friction;
  parameters.viscous_friction = physics.damping;
  parameters.end_effector = franka_core::endEffectorFromUrdf(urdf, options.arm_id);
  if (hand) {
    parameters.F_T_NE = kHandF_T_NE;
  }
  parameters.has_hand = hand;
  parameters.rules = InterfaceRules::kFci;
  parameters.protocol_version = protocolsOf(options).newest;
  return parameters;
}

std::optional<fci::SimRobot::Hand> servedHand(const ArmOptions& options, World& world, bool hand) {
  if (!hand || options.tool != Tool::kGripper) {
    return {};
  }
  return fci::servedHand(world.hand(options.arm_id, options.arm_id));
}

}  // namespace

ServedArm::ServedArm(const ArmOptions& options, World& world) : options_(options) {
  const std::string urdf = robotText(options);
  const JointPhysics physics = jointPhysics(options);
  const bool hand = urdf.find(options.arm_id + "_finger_joint1") != std::string::npos;
  const ControlUnitParameters unit = unitParameters(options, urdf, physics, hand);
  world.addRobot(
      describeRobot(options, urdf, physics, hand, fci::restingNear(kReady, unit.joint_stiffness)));
  std::optional<fci::SimRobot::Vacuum> vacuum;
  if (options.tool == Tool::kVacuum) {
    vacuum.emplace();
  }
  robot_.emplace(unit, world.arm(options.arm_id, options.arm_id),
                 fci::servedAt(options.ip, protocolsOf(options), unit.model),
                 servedHand(options, world, hand), vacuum);
  const auto tell = [name = options.arm_id + " at " + options.ip](const std::string& what) {
    std::fprintf(stderr, "franka_sim: %s: %s\n", name.c_str(), what.c_str());
  };
  robot_->onCollision(tell);
  robot_->onRefusal(tell);
}

std::string ServedArm::protocols() const {
  const fci::ProtocolRange range = protocolsOf(options_);
  const std::string newest = std::to_string(range.newest);
  return range.oldest == range.newest ? newest : std::to_string(range.oldest) + " to " + newest;
}

}  // namespace franka_sim
