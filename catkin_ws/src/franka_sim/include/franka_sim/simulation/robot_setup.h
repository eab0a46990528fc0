// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace franka_sim {

/// The text of a file. @throws std::runtime_error if it cannot be read.
std::string readFile(const std::string& name);

/// A file of a package of this workspace: from the install space that this library is part of
/// (`../share/<package>`), or else from the sources. Empty if there is none.
std::string packageFile(const std::string& package, const std::string& file);

/// The file of a world: a file's name, or the name of one that is installed with franka_sim
/// (stone.xml); empty for the empty world. @throws MissingFile if there is none
std::string worldFile(const std::string& name);

/// Returns the path of a package's file, empty if there is none; `file` is relative to the package.
using PackageFinder =
    std::function<std::string(const std::string& package, const std::string& file)>;

/// The path of a file that a robot's or a world's description names: `package://NAME/FILE`,
/// the address of a file, or a path, which is returned unchanged. @returns empty if the package or
/// its file does not exist.
std::string fileOfUri(const std::string& uri, const PackageFinder& find);

/// Converts `package://name/path`, `model://name` and addresses of files to file names; empty if
/// unknown. Where ROS is (ROS_PACKAGE_PATH is set), its packages are searched too: themselves, and
/// the folders that they export with `<gazebo_ros gazebo_model_path="..."/>`.
std::string resolveUri(const std::string& uri);

/// A robot of a world, as the user describes it.
struct RobotSetup {
  std::string robot{"panda"};  ///< "panda" or "fr3"
  std::string arm_id;          ///< prefix in the URDF; unique in the world
  std::string urdf;  ///< file; empty: the robot with hand that is installed with franka_sim
  std::array<double, 3> base{};  ///< position of the robot in the world [m]
  double yaw{0.0};               ///< rotation of the robot in the world about the vertical [rad]
  std::string realism;           ///< as readRealism reads it
  bool meshes{false};  ///< shows the robot that is installed with franka_sim by its meshes, if they
                       ///< are installed
};

/// A robot that was added to a world, and what its units need.
struct RobotInWorld {
  ControlUnitParameters unit;  ///< of its own interface, in the newest version
  RobotPhysics physics;        ///< of its parts
  ArmPlant* arm;               ///< valid while the robot is in the world
  HandPlant* hand;             ///< null if the robot has none
};

/// Adds the robot to the world, in the ready pose.
/// @param profile if the realism names none @param hand false: the robot that comes along has none;
/// a description of one's own keeps what it has
/// @throws std::exception with a sentence for files, descriptions and values that cannot be used;
/// then the world is unchanged.
RobotInWorld addRobot(const RobotSetup& setup, const char* profile, World& world, bool hand = true);

/// The description (URDF) of a robot with hand that is installed with franka_sim.
/// @param robot "panda" or "fr3"
/// @param arm_id prefix of all links and joints
/// @throws std::runtime_error if the file is missing
std::string robotText(const std::string& robot, const std::string& arm_id);

/// A description of a robot without its hand: without the link `<arm_id>_hand` and all that is
/// attached to it; the same if there is none. @throws std::runtime_error for text that is no XML
std::string withoutHand(const std::string& urdf, const std::string& arm_id);

/// A description whose links look like those of the robot.
struct RobotLook {
  std::string urdf;                  ///< the text
  std::vector<std::string> missing;  ///< meshes of franka_description that are not installed
};

/// Gives the links of `robotText` the visual meshes of franka_description; a link whose mesh is
/// missing keeps its simple shapes. Collisions stay as they are.
RobotLook robotWithMeshes(const std::string& robot, const std::string& arm_id);

}  // namespace franka_sim
