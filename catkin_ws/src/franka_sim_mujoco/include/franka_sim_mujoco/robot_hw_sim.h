// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/physics_config.h>
#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <transmission_interface/transmission_info.h>
#include <urdf/model.h>

#include <functional>
#include <string>
#include <vector>

namespace franka_sim {
class World;
}

namespace franka_sim_mujoco {

/// Runs a piece of work in the stepping thread between two ticks and returns when it is done, also
/// while the simulation is paused. Rethrows what the work throws; throws std::runtime_error with a
/// sentence when the stepping thread does not come by in time. For service and action threads; not
/// for the 1 kHz loop.
using BetweenTicks = std::function<void(const std::function<void()>& work)>;

/// A robot of the simulated world, as a RobotHWSim plugin gets to know it.
struct RobotHandle {
  franka_sim::World* world;  ///< only to be touched in initSim, readSim, writeSim and between ticks
  std::string name;          ///< of the robot in the world
  std::string urdf;          ///< the text of its description
  franka_sim::JointPhysics
      arm_physics;  ///< what the world's joints have of rotor inertia and friction
  BetweenTicks between_ticks;
  std::string robot_type;  ///< what the arm is, "panda" or "fr3"; empty where there is none
};

/// Base class of simulated hardware, shaped like gazebo_ros_control's (decision 34): plugins of
/// this type are named by the URDF's <robotSimType>. initSim runs once in the stepping thread while
/// it stands still; readSim, the controller manager's update and writeSim then run in every tick of
/// 1 ms.
class RobotHWSim : public hardware_interface::RobotHW {
 public:
  ~RobotHWSim() override = default;

  /// @param robot_namespace of the robot's topics and parameters
  /// @returns false when the robot cannot be simulated, having logged why or set `failure`; it is
  /// then taken out of the world again.
  virtual bool initSim(const std::string& robot_namespace, ros::NodeHandle model_nh,
                       RobotHandle robot, const urdf::Model* urdf_model,
                       std::vector<transmission_interface::TransmissionInfo> transmissions) = 0;
  /// Why initSim returned false, as a sentence for whoever asked for the robot; empty: see the log.
  virtual std::string failure() const { return ""; }
  virtual void readSim(ros::Time time, ros::Duration period) = 0;
  virtual void writeSim(ros::Time time, ros::Duration period) = 0;
  /// A controller threw an exception: what it commanded must not go on. Every cycle in which it
  /// does; there is no call with false.
  virtual void eStopActive(bool /*active*/) {}
  /// The world was reset, or joints were put elsewhere: forget velocities and filters.
  virtual void worldWasReset() {}
};

}  // namespace franka_sim_mujoco
