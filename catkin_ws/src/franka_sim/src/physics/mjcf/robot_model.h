// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "physics/urdf/urdf_reader.h"
#include "physics/urdf/urdf_robot.h"

namespace franka_sim::physics {

/// Links that never move against each other: one MuJoCo body. They are fused here rather than kept
/// as jointless bodies, because a third of the bodies costs a third of the kinematics.
struct Segment {
  int link{-1};    ///< the link whose name and frame the body has
  int parent{-1};  ///< index of the parent segment, -1: the world
  int joint{-1};   ///< index of the joint between it and its parent, -1: fixed in the world
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  ///< in the parent's body frame
  std::vector<std::pair<int, Eigen::Isometry3d>> links;   ///< with their poses in the body frame
  UrdfInertial inertial;                                  ///< of all links together, body frame
};

/// A robot ready for writing as MJCF.
struct RobotModel {
  RobotDescription description;
  UrdfRobot urdf;
  std::vector<Segment> segments;  ///< parents before children

  bool moves(const std::string& joint) const noexcept;
  /// Joint stops: the description's, else the URDF's limits [rad] or [m].
  std::array<double, 2> stops(const UrdfJoint& joint) const;
  /// Start position of a joint [rad] or [m]: the description's value, the leader's for mimic
  /// joints, else the value nearest to zero within the stops.
  double initialPosition(const UrdfJoint& joint) const;
  /// Apparent inertia of a joint; if not given 0 (fingers: kFingerArmature).
  double armature(const UrdfJoint& joint) const;
  /// Of the URDF's <dynamics>, but 0 for arms whose physics the description has, and for their
  /// fingers: in Franka's URDFs these values have another meaning (decision 1).
  double damping(const UrdfJoint& joint) const;
  double friction(const UrdfJoint& joint) const;
  /// Whether a link slides and carries no moving link: a finger, not a lift.
  bool isFinger(const UrdfLink& link) const noexcept;
  /// Whether a joint is, by name, one of the seven of a Franka arm or the two of a hand.
  bool isFranka(const UrdfJoint& joint) const;

 private:
  /// Whether the description has the physics of a joint: of an arm's, and so of its fingers.
  bool hasPhysics(const UrdfJoint& joint) const;
};

/// Reads and checks a robot.
/// @throws std::runtime_error with a sentence: errors of readUrdf, moving links without mass, names
/// of joints that do not exist, starts outside the stops, bad parameters.
RobotModel buildRobot(const RobotDescription& description);

}  // namespace franka_sim::physics
