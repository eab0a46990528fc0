// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "physics/urdf_robot.h"

namespace franka_sim::physics {

/// Links that never move against each other: one MuJoCo body. Fused here rather than left as
/// jointless bodies, because a third of the bodies costs a third of the kinematics.
struct Segment {
  int link{-1};    ///< the link that gives the body its name and frame
  int parent{-1};  ///< index of the parent segment, -1: the world
  int joint{-1};   ///< index of the joint that moves it against its parent, -1: fixed in the world
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  ///< in the parent's body frame
  std::vector<std::pair<int, Eigen::Isometry3d>> links;   ///< with their poses in the body frame
  UrdfInertial inertial;                                  ///< of all links together, body frame
};

/// A robot ready to be written as MJCF.
struct RobotModel {
  RobotDescription description;
  UrdfRobot urdf;
  std::vector<Segment> segments;  ///< parents before children

  bool moves(const std::string& joint) const noexcept;
  /// Joint stops: the description's, else the URDF's limits [rad] or [m].
  std::array<double, 2> stops(const UrdfJoint& joint) const;
  /// Where a joint starts [rad] or [m]: the description's value, the leader's for mimic joints,
  /// else the value nearest to zero within the stops.
  double initialPosition(const UrdfJoint& joint) const;
  /// Apparent inertia, friction and damping of a joint by the description. When it names none:
  /// inertia 0 (fingers: kFingerArmature), the rest as in the URDF, but 0 for Franka arms and
  /// hands, whose URDFs mean something else by it (decision 1).
  double armature(const UrdfJoint& joint) const;
  double damping(const UrdfJoint& joint) const;
  double friction(const UrdfJoint& joint) const;
  /// Whether a link slides and carries nothing that moves: a finger, not a lift.
  bool isFinger(const UrdfLink& link) const noexcept;
  /// Whether a joint is one of the seven of a Franka arm or the two of a hand, by the names.
  bool isFranka(const UrdfJoint& joint) const;
};

/// Reads and checks a robot.
/// @throws std::runtime_error with a sentence: what readUrdf refuses, moving links without mass,
/// names of joints that do not exist, starts outside the stops, bad parameters.
RobotModel buildRobot(const RobotDescription& description);

}  // namespace franka_sim::physics
