// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/serve/sim_robot.h>

#include <string>

#include "options.h"

namespace franka_sim {

/// One arm of franka_sim, in the world and on the network.
class ServedArm {
 public:
  /// @param world outlives the arm.
  /// @throws std::runtime_error if a file, the robot's description or the network is not usable.
  ServedArm(const ArmOptions& options, World& world);

  fci::SimRobot& robot() noexcept { return robot_; }
  const ArmOptions& options() const noexcept { return options_; }
  /// Protocol versions for the user, for example "3 to 5".
  std::string protocols() const;

 private:
  ArmOptions options_;
  fci::SimRobot robot_;
};

}  // namespace franka_sim
