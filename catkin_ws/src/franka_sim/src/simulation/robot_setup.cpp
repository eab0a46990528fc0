// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/protocols.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/simulation/files.h>
#include <franka_sim/simulation/robot_setup.h>
#include <franka_sim/simulation/robot_text.h>

#include <cmath>
#include <stdexcept>

namespace franka_sim {
namespace {

constexpr double kFingersAtStart = 0.001;  // [m] each

std::string describe(const RobotSetup& setup, bool hand) {
  if (!setup.urdf.empty()) {
    return readFile(setup.urdf);
  }
  const std::string urdf = setup.meshes ? robotWithMeshes(setup.robot, setup.arm_id).urdf
                                        : robotText(setup.robot, setup.arm_id);
  return hand ? urdf : withoutHand(urdf, setup.arm_id);
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
  applyRestOffset(kJointStiffness, setup.arm_id, robot);
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

RobotInWorld addRobot(const RobotSetup& setup, const char* profile, World& world, bool hand) {
  const std::string& id = setup.arm_id;
  const std::string urdf = describe(setup, hand);
  const RobotPhysics physics = physicsOf(setup, profile);
  const bool has_hand = urdf.find(id + "_finger_joint1") != std::string::npos;
  const ControlUnitParameters unit = unitParameters(setup, urdf, physics, has_hand);
  world.addRobot(describeRobot(setup, urdf, physics, has_hand));
  return {unit, physics, &world.arm(id, id), has_hand ? &world.hand(id, id) : nullptr};
}

}  // namespace franka_sim
