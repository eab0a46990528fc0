// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <memory>
#include <string>
#include <vector>

#include "physics/mjcf_robot.h"
#include "physics/robot_model.h"

namespace franka_sim_mujoco::physics {

/// An MJCF world file, made ready for robots to be merged in: includes expanded, file names
/// absolute, the physics settings of this simulator set, geoms named, and compiled once as a check.
class MjcfWorld {
 public:
  /// @param file path of the MJCF; empty: ground, light and sky.
  /// @throws std::runtime_error naming the file and what is wrong.
  explicit MjcfWorld(const std::string& file);

  /// The world with robots as MJCF text. @param visuals shapes to look at for the robots.
  /// @throws std::runtime_error as writeRobot, or when a robot's names are taken by the world.
  std::string merge(const std::vector<const RobotModel*>& robots, bool visuals) const;

  /// "World file <path>" or "The built-in world".
  const std::string& title() const noexcept { return title_; }
  const std::vector<WorldGeom>& geoms() const noexcept { return geoms_; }

 private:
  void load(const std::string& file);
  void normalise(const std::string& folder);
  void inspect();
  void rankFrictions(tinyxml2::XMLElement* root) const;

  std::string title_;
  tinyxml2::XMLDocument document_;
  double angle_unit_{1};
  std::vector<WorldGeom> geoms_;
  bool has_priorities_{false};  ///< the author decided which geom's friction counts
};

}  // namespace franka_sim_mujoco::physics
