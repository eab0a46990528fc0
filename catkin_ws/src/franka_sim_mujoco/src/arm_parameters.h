// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <ros/node_handle.h>
#include <urdf/model.h>

#include <array>
#include <optional>
#include <string>

namespace franka_sim_mujoco {

/// The control unit's configuration from the parameters of a robot's namespace, with the names of
/// the original franka_gazebo. Defaults come from the robot's URDF: the end effector is everything
/// behind the flange, F_T_NE the described one (decision 7). A parameter F_T_NE that differs is
/// followed, with a warning. Gravity is the world's unless the parameter gravity_vector is set.
/// @param robot is in the world between ticks @param arm one of its arms
/// @throws std::invalid_argument with a sentence for the first error
franka_sim::ControlUnitParameters readArmParameters(const ros::NodeHandle& node,
                                                    const RobotHandle& robot,
                                                    const SimulatedArm& arm);

/// The physics of a robot as requested by the parameter `realism`, of this namespace or of one
/// above it. Without franka_description: the default physics, with a warning.
/// @param robot_type "panda" or "fr3" @param profile if the parameter is missing or names none
/// @throws std::exception with a sentence for a wrong parameter or file
franka_sim::RobotPhysics readPhysics(const ros::NodeHandle& node, const std::string& robot_type,
                                     const char* profile);

/// Stiffness of the internal joint impedance controller [Nm/rad]: the proportional gains
/// `motion_generators/position/gains/<arm_id>_jointN/p`. The original follows positions by one PID
/// per joint; here the robot's own controller does, whose damping follows from its stiffness: other
/// gains have no counterpart. @throws std::invalid_argument with a sentence
std::array<double, 7> readJointStiffness(const ros::NodeHandle& node, const std::string& arm_id,
                                         const std::array<double, 7>& fallback);

/// The gains of `motion_generators` that are set but have no effect here, separated by commas:
/// those of velocities, and the integral and derivative ones of positions; empty if none.
/// @throws std::invalid_argument with a sentence for one that is not a number
std::string gainsWithoutEffect(const ros::NodeHandle& node, const std::string& arm_id);

/// The prefix of an arm's joint names: the parameter arm_id, else the namespace without slashes,
/// else the robot's name. @throws std::invalid_argument with a sentence if it is empty or not a
/// text
std::string readArmId(const ros::NodeHandle& node, const std::string& robot_namespace,
                      const std::string& robot_name);

/// Sentence for the first threshold that is negative or not a number; empty if none.
std::string checkThresholds(const franka_sim::CollisionThresholds& thresholds);

/// Sentence for a log about the first lower threshold above its upper one, which robot and
/// simulation accept unchanged; empty if none.
std::string thresholdRemark(const franka_sim::CollisionThresholds& thresholds);

/// The type of an arm, and how it was determined.
struct RobotType {
  std::string name;     ///< "panda" or "fr3"
  std::string why;      ///< clause that continues "simulated as one:"
  std::string warning;  ///< clause: the URDF's type if it contradicts the parameter; or empty
};

bool isRobotType(const std::string& name);

/// Determines whether an arm is a Panda or an FR3. `configured` counts if given. Otherwise: the
/// positions that the URDF allows for the arm's joints, if only one of the two robots can reach
/// them all; else the joints' velocities, if they are those of one of the two; else whether the
/// URDF is called fr3. The name comes last, because an arm on a mobile base, or one of two, has the
/// name of the whole. Thread-safe.
/// @param configured one for which isRobotType() is true; empty if not configured
/// @param arm_id prefix of the arm's joints
RobotType determineRobotType(const std::optional<std::string>& configured, const urdf::Model& urdf,
                             const std::string& arm_id);

}  // namespace franka_sim_mujoco
