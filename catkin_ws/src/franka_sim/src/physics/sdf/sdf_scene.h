// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "physics/meshes/mesh_conversion.h"
#include "physics/sdf/camera_sensor.h"
#include "physics/urdf/urdf_robot.h"

namespace franka_sim::physics {

/// Contact properties of a surface that both SDF and MuJoCo have.
struct SdfSurface {
  double mu{1};                   ///< Coulomb friction, Gazebo's default
  std::optional<double> torsion;  ///< torsional friction as a lever [m]
  std::optional<double> kp, kd;   ///< contact stiffness [N/m] and damping [N s/m]
  static constexpr int kEveryBit = 65535;
  int bitmask{kEveryBit};  ///< two surfaces collide if these share a bit
};

/// Default color.
inline constexpr std::array<double, 4> kGrey{{0.7, 0.7, 0.7, 1}};

struct SdfShape {
  enum class Kind { kBox, kSphere, kCylinder, kCapsule, kEllipsoid, kPlane, kMesh };
  Kind kind{Kind::kBox};
  std::string name;
  Eigen::Vector3d size{Eigen::Vector3d::Zero()};  ///< box: edges; ball: r; cylinder, capsule: r,
                                                  ///< length; ellipsoid: radii; plane: edges [m]
  MeshSource mesh;
  Eigen::Isometry3d pose{
      Eigen::Isometry3d::Identity()};         ///< in the link; a plane's z is its normal
  SdfSurface surface;                         ///< of a collision
  std::optional<std::array<double, 4>> rgba;  ///< of a visual with a color
  double opacity{1};                          ///< of a visual
};

struct SdfLight {
  enum class Kind { kPoint, kSpot, kDirectional };
  Kind kind{Kind::kPoint};
  std::string name;
  int link{-1};  ///< -1: the world
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};
  Eigen::Vector3d direction{0, 0, -1};
  std::array<double, 3> diffuse{{1, 1, 1}}, specular{{0.1, 0.1, 0.1}};
  std::array<double, 3> attenuation{{1, 0, 0}};  ///< constant, linear, quadratic
  double cutoff{0.785};                          ///< half angle of a spot [rad]
  bool shadows{false};
};

struct SdfCamera : CameraSensor {
  SdfCamera(CameraSensor camera, int of) : CameraSensor(std::move(camera)), link(of) {}
  int link;
};

struct SdfLink {
  std::string name;   ///< with its models: "outer::inner::link"
  std::string model;  ///< outermost model
  bool is_static{false};
  bool gravity{true};
  std::optional<bool> self_collide;                       ///< without it the model's
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  ///< in the world
  UrdfInertial inertial;
  std::vector<SdfShape> collisions, visuals;
};

struct SdfJoint {
  enum class Kind { kFixed, kHinge, kSlide, kBall };
  std::string name;
  Kind kind{Kind::kFixed};
  int parent{-1}, child{-1};                          ///< links; parent -1: the world
  Eigen::Vector3d position{Eigen::Vector3d::Zero()};  ///< in the world
  Eigen::Vector3d axis{Eigen::Vector3d::UnitZ()};     ///< world axes
  std::optional<std::array<double, 2>> limits;        ///< [rad] or [m]
  double damping{0}, friction{0}, stiffness{0}, reference{0};
};

/// A top-level model.
struct SdfModel {
  std::string name;
  Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  ///< in the world
  std::vector<int> links;
  bool self_collide{false};
};

/// The content of an SDF text, with poses in the world.
struct SdfScene {
  std::array<double, 3> gravity{{0, 0, -9.81}};
  std::vector<SdfModel> models;
  std::vector<SdfLink> links;
  std::vector<SdfJoint> joints;
  std::vector<SdfLight> lights;
  std::vector<SdfCamera> cameras;
  std::array<double, 3> ambient{{0.4, 0.4, 0.4}};
  std::optional<std::array<double, 3>> background;
  std::set<std::string> unsupported;  ///< elements of the text that are not simulated
};

/// Whether a text's root element is <sdf> (or <gazebo>, as in old versions), or a <model> or
/// <world> without it.
bool looksLikeSdf(const std::string& text);

/// Reads an SDF text with a world, or with one model.
///
/// Included models and meshes are searched by `resolve`, next to the file, and in the folders of
/// GAZEBO_MODEL_PATH, SDF_PATH and GAZEBO_RESOURCE_PATH; `model://sun` and `model://ground_plane`
/// always exist. Settings of Gazebo's own solver and user interface (<physics>, <gui>, min_depth,
/// max_vel, max_contacts and similar) have no meaning here and are ignored; all other elements
/// without counterpart, unknown ones too, are listed in `unsupported`.
/// @param title names the text in errors
/// @param model_name empty: a world (or a lone model in place of one) is read; else the text's one
/// model, under this name
/// @throws std::runtime_error with a sentence: an error in the text, no world in the text.
SdfScene readSdf(const std::string& text, const std::string& folder, const std::string& title,
                 const ResourceResolver& resolve, const std::string& model_name = "");

/// Red, green and blue (0 to 1) in a child element, with or without opacity; `fallback` if there is
/// none.
std::array<double, 4> readColor(const tinyxml2::XMLElement& element, const char* name,
                                const std::array<double, 4>& fallback, const std::string& where);

/// The <geometry> of a collision or visual as a shape at the origin; empty if it has no
/// counterpart, which is then added to `unsupported`.
/// @param what names the element, e.g. "collision 'c' of 'model::link'".
/// @throws std::runtime_error when a number is missing or is not one.
std::optional<SdfShape> readShape(const tinyxml2::XMLElement& thing, const std::string& what,
                                  std::set<std::string>* unsupported);
/// Friction and contact parameters of a <collision>.
SdfSurface readSurface(const tinyxml2::XMLElement& collision, const std::string& what,
                       std::set<std::string>* unsupported);
/// A visual's color: its diffuse color, or that of one of Gazebo's plain materials. Empty if it
/// has no material.
std::optional<std::array<double, 4>> readMaterial(const tinyxml2::XMLElement& visual,
                                                  const std::string& what,
                                                  std::set<std::string>* unsupported);

}  // namespace franka_sim::physics
