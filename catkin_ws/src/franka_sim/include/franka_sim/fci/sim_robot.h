// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/robot_front.h>

#include <optional>

namespace franka_sim::fci {

/// Holds the units, which must exist before their servers.
struct OwnedUnits {
  OwnedUnits(const ControlUnitParameters& unit, ArmPlant& arm,
             const std::optional<WholeRobot::Hand>& hand,
             const std::optional<VacuumGripperParameters>& vacuum, unsigned command_delay)
      : units(unit, arm, hand, vacuum, command_delay) {}

  WholeRobot units;
};

/// One robot on the network: its units with their servers.
/// Called by one thread.
class SimRobot final : private OwnedUnits, public RobotFront {
 public:
  struct Hand {
    HandPlant* plant;
    GripperParameters parameters;
    std::uint16_t port{franka_core::fci::kGripperPort};  ///< 0: the system chooses
  };
  struct Vacuum {
    VacuumGripperParameters parameters;
    std::uint16_t port{franka_core::fci::kVacuumGripperPort};  ///< 0: the system chooses
  };

  /// @param arm outlives the robot, as the hand's plant does. @param command_delay [ticks]
  /// @throws std::runtime_error if a port cannot be opened, std::invalid_argument if a parameter is
  /// invalid.
  SimRobot(const ControlUnitParameters& unit, ArmPlant& arm, RobotServerParameters server,
           const std::optional<Hand>& hand, const std::optional<Vacuum>& vacuum = {},
           unsigned command_delay = 0);

  WholeRobot& whole() noexcept { return units; }
  ControlUnit& unit() noexcept { return units.unit(); }
  CommandLink& link() noexcept { return units.link(); }
  /// Null if the robot has none.
  VacuumGripperUnit* vacuum() noexcept { return units.vacuum(); }

  /// As those of WholeRobot.
  std::uint64_t hash() const noexcept { return units.hash(); }
  void restart() noexcept { units.restart(); }
  void halt() noexcept { units.halt(); }
};

}  // namespace franka_sim::fci
