// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/fci/sim_robot.h>

#include <utility>

namespace franka_sim::fci {

namespace {

std::optional<WholeRobot::Hand> unitOf(const std::optional<SimRobot::Hand>& hand) {
  return hand ? std::optional<WholeRobot::Hand>({hand->plant, hand->parameters}) : std::nullopt;
}

std::optional<VacuumGripperParameters> unitOf(const std::optional<SimRobot::Vacuum>& vacuum) {
  return vacuum ? std::optional(vacuum->parameters) : std::nullopt;
}

template <typename Tool>
std::optional<std::uint16_t> portOf(const std::optional<Tool>& tool) {
  return tool ? std::optional(tool->port) : std::nullopt;
}

}  // namespace

SimRobot::SimRobot(const ControlUnitParameters& unit, ArmPlant& arm, RobotServerParameters server,
                   const std::optional<Hand>& hand, const std::optional<Vacuum>& vacuum,
                   unsigned command_delay)
    : OwnedUnits(unit, arm, unitOf(hand), unitOf(vacuum), command_delay),
      RobotFront(units, std::move(server), {portOf(hand), portOf(vacuum)}) {}

}  // namespace franka_sim::fci
