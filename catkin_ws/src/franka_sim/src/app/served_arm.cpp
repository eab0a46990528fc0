// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "served_arm.h"

#include <franka_sim/robot/realism.h>
#include <franka_sim/serve/sim_robot.h>

#include <cstdio>

namespace franka_sim {
namespace {

ProtocolRange servedProtocols(const ArmOptions& options) {
  return options.protocol != 0 ? ProtocolRange{options.protocol, options.protocol}
                               : protocolsOf(options.robot);
}

// Adds the arm to the world and to the network.
fci::SimRobot makeRobot(const ArmOptions& options, World& world) {
  const RobotInWorld robot = addRobot(options, kServedProfile, world);
  std::optional<fci::SimRobot::Vacuum> vacuum;
  if (options.tool == Tool::kVacuum) {
    vacuum.emplace();
  }
  std::optional<fci::SimRobot::Hand> hand;
  if (robot.hand != nullptr && options.tool == Tool::kGripper) {
    hand = fci::makeHand(*robot.hand, robot.physics.gripper);
  }
  return fci::makeSimRobot(options.ip, servedProtocols(options), robot.unit, *robot.arm, hand,
                           vacuum, robot.physics.command_delay);
}

}  // namespace

ServedArm::ServedArm(const ArmOptions& options, World& world)
    : options_(options), robot_(makeRobot(options, world)) {
  const auto report = [name = options.arm_id + " at " + options.ip](const std::string& what) {
    std::fprintf(stderr, "franka_sim: %s: %s\n", name.c_str(), what.c_str());
  };
  robot_.onCollision(report);
  robot_.onRefusal(report);
}

std::string ServedArm::protocols() const {
  const ProtocolRange range = servedProtocols(options_);
  const std::string newest = std::to_string(range.newest);
  return range.oldest == range.newest ? newest : std::to_string(range.oldest) + " to " + newest;
}

}  // namespace franka_sim
