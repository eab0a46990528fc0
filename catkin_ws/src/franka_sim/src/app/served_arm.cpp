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

constexpr double kFingersAtStart = 0.001;  // [m] each

// In the descriptions of the program all links and joints have the name of their robot as prefix.
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

RobotPhysics physicsOf(const ArmOptions& options) {
  const std::string file = packageFile("franka_description", "config/physics.yaml");
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find config/physics.yaml of franka_description.");
  }
  return readRobotPhysics(file, options.robot, readRealism(options.realism, kServedProfile));
}

RobotDescription describeRobot(const ArmOptions& options, const std::string& urdf,
                               const RobotPhysics& physics, bool hand) {
  RobotDescription robot;
  robot.name = options.arm_id;
  robot.urdf = urdf;
  robot.resolve = resolveUri;
  robot.base.position = options.base;
  robot.base.orientation = {std::cos(0.5 * options.yaw), 0, 0, std::sin(0.5 * options.yaw)};
  startAt(kReadyPose, options.arm_id, robot);
  comeToRest(kJointStiffness, options.arm_id, robot);
  if (hand) {
    for (const char* finger : {"_finger_joint1", "_finger_joint2"}) {
      robot.initial_positions[options.arm_id + finger] = kFingersAtStart;
    }
  }
  applyPhysics(physics, options.arm_id, robot);
  return robot;
}

fci::ProtocolRange protocolsOf(const ArmOptions& options) {
  return options.protocol != 0 ? fci::ProtocolRange{options.protocol, options.protocol}
                               : fci::protocolsOf(options.robot);
}

ControlUnitParameters unitParameters(const ArmOptions& options, const std::string& urdf,
                                     const RobotPhysics& physics, bool hand) {
  ControlUnitParameters parameters{franka_core::ArmModel::fromUrdf(urdf, options.arm_id)};
  applyPhysics(physics, parameters);
  parameters.end_effector = franka_core::endEffectorFromUrdf(urdf, options.arm_id);
  if (hand) {
    parameters.F_T_NE = kHandF_T_NE;
  }
  parameters.has_hand = hand;
  return parameters;
}

// Adds the arm to the world and to the network.
fci::SimRobot makeRobot(const ArmOptions& options, World& world) {
  const std::string& id = options.arm_id;
  const std::string urdf = robotText(options);
  const RobotPhysics physics = physicsOf(options);
  const bool hand = urdf.find(id + "_finger_joint1") != std::string::npos;
  const ControlUnitParameters unit = unitParameters(options, urdf, physics, hand);
  world.addRobot(describeRobot(options, urdf, physics, hand));
  std::optional<fci::SimRobot::Vacuum> vacuum;
  if (options.tool == Tool::kVacuum) {
    vacuum.emplace();
  }
  const bool gripper = hand && options.tool == Tool::kGripper;
  std::optional<fci::SimRobot::Hand> served_hand;
  if (gripper) {
    served_hand = fci::servedHand(world.hand(id, id), physics.gripper);
  }
  return fci::servedRobot(options.ip, protocolsOf(options), unit, world.arm(id, id), served_hand,
                          vacuum, physics.command_delay);
}

}  // namespace

ServedArm::ServedArm(const ArmOptions& options, World& world)
    : options_(options), robot_(makeRobot(options, world)) {
  const auto tell = [name = options.arm_id + " at " + options.ip](const std::string& what) {
    std::fprintf(stderr, "franka_sim: %s: %s\n", name.c_str(), what.c_str());
  };
  robot_.onCollision(tell);
  robot_.onRefusal(tell);
}

std::string ServedArm::protocols() const {
  const fci::ProtocolRange range = protocolsOf(options_);
  const std::string newest = std::to_string(range.newest);
  return range.oldest == range.newest ? newest : std::to_string(range.oldest) + " to " + newest;
}

}  // namespace franka_sim
