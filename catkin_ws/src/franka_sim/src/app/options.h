// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/host.h>
#include <franka_sim/simulation/robot_setup.h>

#include <cstdint>
#include <string>
#include <vector>

#include "fci/sockets.h"

namespace franka_sim {

/// The tool of an arm.
enum class Tool { kGripper, kVacuum, kNone };

/// One arm of the world.
struct ArmOptions : RobotSetup {
  std::string ip{"127.0.0.1"};
  std::uint16_t protocol{0};  ///< 0: every version of the robot's generation
  Tool tool{Tool::kGripper};
  std::uint16_t control_port{1340};  ///< of the control interface; 0: none
};

/// Desk, the robots' web interface.
struct DeskOptions {
  bool served{false};
  std::string address;   ///< ADDRESS:PORT; empty: each robot's own address
  std::string user;      ///< empty: franka_desk's default
  std::string password;  ///< empty: a new one, which franka_desk prints
};

/// The options of franka_sim on the command line.
struct Options {
  std::string help;  ///< to be printed instead of serving robots; empty: not requested
  std::vector<ArmOptions> arms{1};
  std::string world;  ///< MJCF or SDF file, or the name of one that is part of the program
  fci::Pace pace;
  double linger{0.0};  ///< how long the end of the program waits for clients to disconnect [s]
  bool viewer{false};
  DeskOptions desk;
  fci::Descriptor ready;  ///< where it is reported that clients can connect; or none
  bool locked{false};  ///< robots start with closed brakes and without FCI, see SafetyRules::kDesk
};

/// @param options with defaults; an error leaves what was read before it.
/// @throws std::invalid_argument that names the error.
void readOptions(int argc, const char* const* argv, Options& options);

}  // namespace franka_sim
