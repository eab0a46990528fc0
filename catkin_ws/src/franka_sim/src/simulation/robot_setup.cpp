// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/protocols.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/simulation/files.h>
#include <franka_sim/simulation/robot_setup.h>

#include <cmath>
#include <stdexcept>

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

std::string robotText(const RobotSetup& setup) {
  if (!setup.urdf.empty()) {
    return readFile(setup.urdf);
  }
  const std::string name = "robots/" + setup.robot + ".urdf";
  const std::string file = packageFile("franka_sim", name);
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find its file " + name +
                             "; give a robot description with --urdf.");
  }
  return withPrefix(readFile(file), setup.robot, setup.arm_id);
}

RobotPhysics physicsOf(const RobotSetup& setup, const char* profile) {
  const std::string file = packageFile("franka_description", "config/physics.yaml");
  if (file.empty()) {
    throw std::runtime_error("franka_sim does not find config/physics.yaml of franka_description.");
  }
  return readRobotPhysics(file, setup.robot, readRealism(setup.realism, profile));
}

RobotDescription describeRobot(const RobotSetup& setup, const std::string& urdf,
                               const RobotPhysics& physics, bool hand) {
  RobotDescription robot;
  robot.name = setup.arm_id;
  robot.urdf = urdf;
  robot.resolve = resolveUri;
  robot.base.position = setup.base;
  robot.base.orientation = {std::cos(0.5 * setup.yaw), 0, 0, std::sin(0.5 * setup.yaw)};
  startAt(kReadyPose, setup.arm_id, robot);
  comeToRest(kJointStiffness, setup.arm_id, robot);
  if (hand) {
    for (const char* finger : {"_finger_joint1", "_finger_joint2"}) {
      robot.initial_positions[setup.arm_id + finger] = kFingersAtStart;
    }
  }
  applyPhysics(physics, setup.arm_id, robot);
  return robot;
}

ControlUnitParameters unitParameters(const RobotSetup& setup, const std::string& urdf,
                                     const RobotPhysics& physics, bool hand) {
  ControlUnitParameters parameters{franka_core::ArmModel::fromUrdf(urdf, setup.arm_id)};
  applyPhysics(physics, parameters);
  parameters.end_effector = franka_core::endEffectorFromUrdf(urdf, setup.arm_id);
  if (hand) {
    parameters.F_T_NE = kHandF_T_NE;
  }
  parameters.has_hand = hand;
  parameters.rules = InterfaceRules::kFci;
  parameters.protocol_version = protocolsOf(setup.robot).newest;
  return parameters;
}

}  // namespace

RobotInWorld addRobot(const RobotSetup& setup, const char* profile, World& world) {
  const std::string& id = setup.arm_id;
  const std::string urdf = robotText(setup);
  const RobotPhysics physics = physicsOf(setup, profile);
  const bool hand = urdf.find(id + "_finger_joint1") != std::string::npos;
  const ControlUnitParameters unit = unitParameters(setup, urdf, physics, hand);
  world.addRobot(describeRobot(setup, urdf, physics, hand));
  return {unit, physics, &world.arm(id, id), hand ? &world.hand(id, id) : nullptr};
}

}  // namespace franka_sim
