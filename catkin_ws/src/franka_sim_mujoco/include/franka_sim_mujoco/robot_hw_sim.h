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

/// Runs work in the stepping thread between two ticks and returns when it is done, also while the
/// simulation is paused. Rethrows exceptions of the work; throws std::runtime_error with a sentence
/// if the stepping thread does not serve it in time. For service and action threads.
/// Not real-time safe.
using BetweenTicks = std::function<void(const std::function<void()>& work)>;

/// A Franka arm of a robot.
struct SimulatedArm {
  std::string arm_id;                ///< prefix of its joints
  std::string type;                  ///< "panda" or "fr3"; empty if the URDF has no such arm
  franka_sim::RobotPhysics physics;  ///< rotor inertia, friction and so on of the world's joints
  /// Of its services, below the robot's namespace: empty for the only arm of a robot, else arm_id,
  /// with _ for characters that ROS does not take.
  std::string service_namespace;
};

/// A robot of the simulated world, as passed to a RobotHWSim plugin.
struct RobotHandle {
  franka_sim::World* world;  ///< use only in readSim, writeSim and between ticks
  std::string name;          ///< of the robot in the world
  std::string urdf;          ///< text of its description
  /// Runs a function between two ticks; by default at once, for a world that nothing steps.
  BetweenTicks between_ticks = [](const std::function<void()>& work) { work(); };
  std::vector<SimulatedArm> arms;  ///< not empty; the first has no type in a robot without arms
  int control_ticks{1};            ///< ticks from one update of the controllers to the next
};

/// Base class of simulated hardware, shaped like gazebo_ros_control's (decision 34): plugins of
/// this type are named by the URDF's `<robotSimType>`. initSim runs once, in the thread of the
/// request that adds the robot, because calls of the ROS master may take long: the other robots are
/// stepped meanwhile, and this one is in the world only within `between_ticks`. Then readSim and
/// writeSim run in every tick of 1 ms, in the stepping thread, and between them, once per
/// controlPeriod of the description, the controller manager's update.
class RobotHWSim : public hardware_interface::RobotHW {
 public:
  ~RobotHWSim() override = default;

  /// @param robot_namespace of the robot's topics and parameters
  /// @returns false if the robot cannot be simulated, after logging why or setting `failure`; it is
  /// then removed from the world.
  virtual bool initSim(const std::string& robot_namespace, ros::NodeHandle model_nh,
                       RobotHandle robot, const urdf::Model* urdf_model,
                       std::vector<transmission_interface::TransmissionInfo> transmissions) = 0;
  /// Why initSim returned false, as a sentence for the caller; empty: see the log.
  virtual std::string failure() const { return ""; }
  /// A line for the simulation's window about the robot's mode and errors; may be empty. Called by
  /// the stepping thread between ticks.
  virtual std::string condition() const { return ""; }
  /// Reads the state of the robot; in each tick, before controllers run.
  virtual void readSim(ros::Time time, ros::Duration period) = 0;
  /// Applies the commands; in each tick, after controllers have run.
  virtual void writeSim(ros::Time time, ros::Duration period) = 0;
  /// A controller threw an exception: its commands must not stay in effect. Called in every cycle
  /// with an exception; never with false.
  virtual void eStopActive(bool /*active*/) {}
  /// The world was reset, or joints were teleported: reset velocities and filters.
  virtual void worldWasReset() {}
  /// What can be reset without the rest of the robot: its arms, or the robot as a whole.
  virtual std::vector<RobotHWSim*> parts() { return {this}; }
};

}  // namespace franka_sim_mujoco
