// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <mujoco/mujoco.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "physics/engine/model_compiler.h"
#include "physics/engine/model_data.h"
#include "physics/engine/model_identity.h"
#include "physics/joints/mujoco_arm.h"
#include "physics/joints/mujoco_drive.h"
#include "physics/joints/mujoco_hand.h"
#include "physics/mjcf/mjcf_world.h"

namespace franka_sim {

namespace physics {

/// In the order of addition.
using Robots = std::vector<std::shared_ptr<const RobotModel>>;

/// Puts robots' joints at their initial positions.
void placeInitially(const mjModel& model, mjData* data, const Robots& robots);
/// Per MuJoCo body the index of its robot, or -1.
std::vector<int> robotOfBody(const mjModel& model, const Robots& robots);

}  // namespace physics

/// The content of a world and the model compiled from it. compile() uses nothing else of the world.
struct WorldChange::Content {
  std::shared_ptr<const physics::MjcfWorld> world;
  physics::Robots robots;
  std::uint64_t generation{0};             ///< of the model that it replaces
  std::string added;                       ///< name of what is added; or empty
  std::function<void(Content&)> describe;  ///< changes `world` or `robots`

  physics::ModelPtr model;
  physics::DataPtr data;  ///< in its initial state
  physics::ModelIdentity identity;
  /// Plants of robots that the change has taken from the world: they come back with their robots.
  std::map<std::string, std::unique_ptr<physics::MujocoArm>> arms{};
  std::map<std::string, std::unique_ptr<physics::MujocoHand>> hands{};
  std::map<std::string, std::unique_ptr<physics::MujocoDrive>> drives{};

  void compile();
};

}  // namespace franka_sim
