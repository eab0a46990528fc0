// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/host.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace franka_sim {

/// What an arm carries and serves.
enum class Tool { kGripper, kVacuum, kNone };

/// One arm of the world.
struct ArmOptions {
  std::string robot{"panda"};  ///< "panda" or "fr3"
  std::string arm_id;          ///< prefix in the URDF; unique in the world
  std::string urdf;            ///< file; empty: the robot with hand that comes with the program
  std::string ip{"127.0.0.1"};
  std::uint16_t protocol{0};     ///< 0: every version of the robot's generation
  std::array<double, 3> base{};  ///< where the robot stands in the world [m]
  double yaw{0.0};               ///< how far it is turned there about the vertical [rad]
  std::string friction{"none"};
  Tool tool{Tool::kGripper};
  std::uint16_t control_port{1340};  ///< of the control interface; 0: none
};

/// What the user asks of franka_sim on the command line.
struct Options {
  std::string help;  ///< to be printed instead of serving robots; empty: not asked for
  std::vector<ArmOptions> arms{1};
  std::string world;  ///< MJCF or SDF file, or the name of one that comes with the program
  fci::Pace pace;
  double linger{0.0};  ///< how long clients may take to go first when the program is to end [s]
  bool viewer{false};
};

/// @throws std::invalid_argument with a sentence that names what is wrong.
Options readOptions(int argc, const char* const* argv);

}  // namespace franka_sim
