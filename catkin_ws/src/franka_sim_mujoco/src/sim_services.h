// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include "service_handlers.h"

namespace franka_sim_mujoco {

class Simulation;

/// The simulation's services: time (pause, step, factor, reset), robots and objects (spawn,
/// delete), states (poses, velocities, joints, pushes, contacts), gravity, snapshots, benchmark;
/// and those of Gazebo, with its types.
class SimServices {
 public:
  /// @param node its namespace contains the services, also pause_physics and unpause_physics
  SimServices(ros::NodeHandle node, Simulation& simulation);
  SimServices(const SimServices&) = delete;
  SimServices& operator=(const SimServices&) = delete;

 private:
  void offerTime();
  void offerRobots();
  void offerBodies();
  void offerStates();
  void offerWorld();
  void offerGazebo();
  void offerGazeboLights();
  void offerGazeboStates();
  void offerGazeboModels();
  void offerGazeboPhysics();

  Simulation& simulation_;
  ServiceHandlers services_;
};

}  // namespace franka_sim_mujoco
