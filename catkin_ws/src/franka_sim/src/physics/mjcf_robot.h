// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "physics/robot_model.h"

namespace franka_sim::physics {

/// A geom that can meet a robot: one of the world's.
struct WorldGeom {
  std::string name, body;
  double friction{1};     ///< sliding
  double torsion{0.005};  ///< [m]
  bool graspable{false};  ///< belongs to a body that is free to move
  bool collides{true};
};

/// Where a robot's MJCF goes.
struct MjcfTarget {
  tinyxml2::XMLElement* assets;
  tinyxml2::XMLElement* worldbody;
  tinyxml2::XMLElement* contact;
  tinyxml2::XMLElement* equality;
  bool visuals;          ///< shapes to look at instead of shapes to collide with
  double angle_unit{1};  ///< [rad] of the document's angle unit
  const std::vector<WorldGeom>* world;
};

/// Writes a robot into an MJCF document: bodies, joints, inertias, shapes, joint brakes (equalities
/// that are inactive at first), coupled joints, what must not collide, and the contact pairs of a
/// grasp. Every attribute that matters is written out, so that defaults of the world file do not
/// reach it.
/// @throws std::runtime_error with a sentence when a collision mesh cannot be used.
void writeRobot(const RobotModel& robot, const MjcfTarget& target);

/// Name of the equality that brakes a joint.
std::string brakeName(const std::string& joint);
/// The link a geom was made for: what stands before the last '/' of the geom's name.
std::string linkOfGeom(const std::string& geom);

}  // namespace franka_sim::physics
