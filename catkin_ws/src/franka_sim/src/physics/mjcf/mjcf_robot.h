// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "physics/mjcf/robot_model.h"

namespace franka_sim::physics {

/// A geom of the world that can collide with a robot.
struct WorldGeom {
  std::string name, body;
  double friction{1};     ///< sliding
  double torsion{0.005};  ///< [m]
  bool graspable{false};  ///< belongs to a free body
  bool collides{true};
};

/// Destination of a robot's MJCF.
struct MjcfTarget {
  tinyxml2::XMLElement* assets;
  tinyxml2::XMLElement* worldbody;
  tinyxml2::XMLElement* contact;
  tinyxml2::XMLElement* equality;
  bool visuals;          ///< visual shapes instead of collision shapes
  double angle_unit{1};  ///< [rad] of the document's angle unit
  const std::vector<WorldGeom>* world;
};

/// Writes a robot into an MJCF document: bodies, joints, inertias, shapes, joint brakes (initially
/// inactive equalities), coupled joints, excluded contacts, and the contact pairs of a grasp. Every
/// relevant attribute is written, so that defaults of the world file have no effect on it.
/// @throws std::runtime_error with a sentence when a collision mesh cannot be used.
void writeRobot(const RobotModel& robot, const MjcfTarget& target);

/// Name of the equality that brakes a joint.
std::string brakeName(const std::string& joint);
/// The link a geom was made for: the part of the geom's name before the last '/'.
std::string linkOfGeom(const std::string& geom);

}  // namespace franka_sim::physics
