// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "physics/sdf/camera_sensor.h"

namespace franka_sim::physics {

/// The shape of a visual or collision element, lengths in [m].
struct UrdfGeometry {
  enum class Shape { kBox, kCylinder, kSphere, kMesh };
  Shape shape{Shape::kBox};
  Eigen::Vector3d size{Eigen::Vector3d::Zero()};  ///< box: edges; cylinder: r, length; sphere: r
  std::string mesh;                               ///< URI
  Eigen::Vector3d scale{Eigen::Vector3d::Ones()};
  Eigen::Isometry3d origin{Eigen::Isometry3d::Identity()};  ///< in the link frame
  std::optional<std::array<double, 4>> rgba;                ///< visuals with a material
};

/// Mass and inertia of a link.
struct UrdfInertial {
  double mass{0};                                    ///< [kg]
  Eigen::Vector3d com{Eigen::Vector3d::Zero()};      ///< link frame [m]
  Eigen::Matrix3d inertia{Eigen::Matrix3d::Zero()};  ///< about com, link axes [kg m^2]
};

/// A link with all that is fixed to it.
struct UrdfLink {
  std::string name;
  std::optional<UrdfInertial> inertial;
  std::vector<UrdfGeometry> collisions, visuals;
  std::vector<CameraSensor> cameras;  ///< of the <gazebo reference> element
  std::optional<double> friction;     ///< mu of the <gazebo reference> element
  bool gravity{true};                 ///< of the <gazebo reference> element
  std::optional<bool> self_collide;   ///< likewise; without it the robot's
  int parent_joint{-1};               ///< index in UrdfRobot::joints, -1 for the root
  std::vector<int> child_joints;      ///< in the order of the file
};

/// A joint between two links.
struct UrdfJoint {
  enum class Type { kFixed, kRevolute, kContinuous, kPrismatic };
  std::string name;
  Type type{Type::kFixed};
  int parent{-1}, child{-1};                                ///< indices in UrdfRobot::links
  Eigen::Isometry3d origin{Eigen::Isometry3d::Identity()};  ///< child link in parent link at q = 0
  Eigen::Vector3d axis{Eigen::Vector3d::UnitX()};           ///< unit, child link frame
  double lower{0}, upper{0};                                ///< [rad] or [m]; revolute, prismatic
  std::string mimic;                                        ///< leading joint, empty: none
  double mimic_multiplier{1}, mimic_offset{0};
  double damping{0}, friction{0};  ///< of <dynamics> [Nm s/rad|N s/m], [Nm|N]
};

/// The part of a URDF that physics needs: a checked tree of links and joints.
struct UrdfRobot {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  int root{-1};
  std::set<std::string> notes;     ///< elements that are not simulated as written
  bool is_static{false};           ///< <static> of a <gazebo> element without a reference
  bool has_control_plugin{false};  ///< of ros_control
  /// Whether links that are not neighbors collide: <self_collide> or <selfCollide> of the <gazebo>
  /// element without a reference. Without it, Gazebo's default (false) for descriptions that were
  /// written for Gazebo, which have its plugin of ros_control; true for all others.
  bool self_collide{true};
  bool describes_self_collide{false};  ///< whether the description has it

  /// Index of a link or joint, -1 if unknown.
  int link(const std::string& link_name) const noexcept;
  int joint(const std::string& joint_name) const noexcept;
};

}  // namespace franka_sim::physics
