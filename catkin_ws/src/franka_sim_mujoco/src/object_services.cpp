// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// SimServices: objects, states, gravity and snapshots.

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_gravity.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim_mujoco/DeleteObject.h>
#include <franka_sim_mujoco/GetBodyState.h>
#include <franka_sim_mujoco/GetJointStates.h>
#include <franka_sim_mujoco/GetWorld.h>
#include <franka_sim_mujoco/RestoreSnapshot.h>
#include <franka_sim_mujoco/SetBodyState.h>
#include <franka_sim_mujoco/SetGravity.h>
#include <franka_sim_mujoco/SetJointStates.h>
#include <franka_sim_mujoco/SpawnObject.h>
#include <franka_sim_mujoco/TakeSnapshot.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "sim_messages.h"
#include "sim_services.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

void describe(Simulation& simulation, GetWorld::Response& response) {
  const SimulationInventory inventory = simulation.inventory();
  response.robots = inventory.robots;
  response.objects = inventory.objects;
  response.bodies = inventory.bodies;
  response.joints = inventory.joints;
  response.cameras = inventory.cameras;
  response.gravity = toVector(inventory.gravity);
  response.paused = inventory.paused;
  response.real_time_factor = inventory.real_time_factor;
  const SimulationState state = simulation.state();
  response.tick = state.tick;
  response.time = state.time;
}

void readJoints(Simulation& simulation, const std::vector<std::string>& names,
                sensor_msgs::JointState& state) {
  simulation.withWorld([&](franka_sim::World& world) {
    state.name = names.empty() ? world.joints() : names;
    for (const std::string& name : state.name) {
      const franka_sim::JointMeasurement joint = jointState(world, name);
      state.position.push_back(joint.position);
      state.velocity.push_back(joint.velocity);
      state.effort.push_back(joint.effort);
    }
  });
  state.header.stamp = simulation.state().time;
}

void setJoints(Simulation& simulation, const SetJointStates::Request& request) {
  const std::vector<double> velocities = request.velocities.empty()
                                             ? std::vector<double>(request.names.size(), 0.0)
                                             : request.velocities;
  if (request.positions.size() != request.names.size() ||
      velocities.size() != request.names.size()) {
    throw std::runtime_error(
        "There are " + std::to_string(request.names.size()) + " joint names, " +
        std::to_string(request.positions.size()) + " positions and " +
        std::to_string(request.velocities.size()) +
        " velocities; each joint needs a position, and a velocity unless all are 0.");
  }
  simulation.robots().setJoints(request.names, request.positions, velocities);
}

}  // namespace

void SimServices::offerWorld() {
  services_.offer<SpawnObject>(
      "spawn_object", [this](SpawnObject::Request& request, SpawnObject::Response& response) {
        response.warning =
            simulation_.robots().spawnObject(request.name, request.xml, fromMessage(request.pose));
      });
  services_.offer<DeleteObject>("delete_object",
                                [this](DeleteObject::Request& request, DeleteObject::Response&) {
                                  simulation_.robots().removeObject(request.name);
                                });
  services_.offer<GetWorld>("get_world",
                            [this](GetWorld::Request& /*request*/, GetWorld::Response& response) {
                              describe(simulation_, response);
                            });
  services_.offer<SetGravity>(
      "set_gravity", [this](SetGravity::Request& request, SetGravity::Response&) {
        const auto gravity = fromMessage(request.gravity);
        simulation_.withWorld([&](franka_sim::World& world) { setGravity(world, gravity); });
      });
  services_.offer<TakeSnapshot>(
      "take_snapshot", [this](TakeSnapshot::Request& request, TakeSnapshot::Response& response) {
        response.state_hash = simulation_.takeSnapshot(request.name);
      });
  services_.offer<RestoreSnapshot>("restore_snapshot", [this](RestoreSnapshot::Request& request,
                                                              RestoreSnapshot::Response& response) {
    response.state_hash = simulation_.restoreSnapshot(request.name);
  });
}

void SimServices::offerStates() {
  services_.offer<GetBodyState>(
      "get_body_state", [this](GetBodyState::Request& request, GetBodyState::Response& response) {
        simulation_.withWorld([&](franka_sim::World& world) {
          response.pose = toMessage(bodyPose(world, request.body));
          response.twist = toMessage(bodyState(world, request.body).twist);
        });
      });
  services_.offer<SetBodyState>(
      "set_body_state", [this](SetBodyState::Request& request, SetBodyState::Response&) {
        const franka_sim::BodyState state{fromMessage(request.pose), fromMessage(request.twist)};
        simulation_.withWorld(
            [&](franka_sim::World& world) { setBodyState(world, request.body, state); });
      });
  services_.offer<GetJointStates>("get_joint_states", [this](GetJointStates::Request& request,
                                                             GetJointStates::Response& response) {
    readJoints(simulation_, request.names, response.state);
  });
  services_.offer<SetJointStates>(
      "set_joint_states", [this](SetJointStates::Request& request, SetJointStates::Response&) {
        setJoints(simulation_, request);
      });
}

}  // namespace franka_sim_mujoco
