// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "sim_services.h"

#include <franka_sim/physics/world_pushes.h>
#include <franka_sim_mujoco/Benchmark.h>
#include <franka_sim_mujoco/DeleteRobot.h>
#include <franka_sim_mujoco/GetBodyPose.h>
#include <franka_sim_mujoco/GetContacts.h>
#include <franka_sim_mujoco/PushBody.h>
#include <franka_sim_mujoco/SetBodyPose.h>
#include <franka_sim_mujoco/SetRealTimeFactor.h>
#include <franka_sim_mujoco/SpawnRobot.h>
#include <franka_sim_mujoco/Step.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "sim_messages.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

SpawnOrder toOrder(const SpawnRobot::Request& request) {
  if (request.joint_names.size() != request.joint_positions.size()) {
    throw std::runtime_error("There are " + std::to_string(request.joint_names.size()) +
                             " joint names but " + std::to_string(request.joint_positions.size()) +
                             " positions.");
  }
  SpawnOrder order;
  order.name = request.name;
  order.urdf = request.urdf;
  order.robot_namespace = request.robot_namespace;
  order.pose = fromMessage(request.pose);
  for (std::size_t i = 0; i < request.joint_names.size(); ++i) {
    order.initial_positions[request.joint_names[i]] = request.joint_positions[i];
  }
  return order;
}

void fill(const SimulationState& state, Step::Response& response) {
  response.tick = state.tick;
  response.time = state.time;
  response.state_hash = state.state_hash;
}

void push(franka_sim::World& world, const PushBody::Request& request) {
  const std::array<double, 3> force{request.force.x, request.force.y, request.force.z};
  const std::array<double, 3> torque{request.torque.x, request.torque.y, request.torque.z};
  checkFinite({force[0], force[1], force[2], torque[0], torque[1], torque[2], request.point.x,
               request.point.y, request.point.z},
              "push");
  if (request.at_point && torque != std::array<double, 3>{}) {
    throw std::runtime_error("A push at a point takes no torque: push the body itself for that.");
  }
  const std::array<double, 3> point{request.point.x, request.point.y, request.point.z};
  pushBody(world, request.body, force, torque, request.ticks,
           request.at_point ? std::optional(point) : std::nullopt);
}

bool between(const franka_sim::Contact& contact, const std::string& body1,
             const std::string& body2) {
  const auto matches = [](const std::string& name, const std::string& body) {
    return name.empty() || name == body;
  };
  return matches(body1, contact.body1) && matches(body2, contact.body2);
}

/// Forces act on the second requested body, whatever the order of the bodies in the physics.
void collectContacts(franka_sim::World& world, const GetContacts::Request& request,
                     GetContacts::Response& response) {
  for (const std::string& body : {request.body1, request.body2}) {
    if (!body.empty()) {
      bodyPose(world, body);  // throws for an unknown body
    }
  }
  for (franka_sim::Contact contact : contacts(world)) {
    if (!between(contact, request.body1, request.body2)) {
      std::swap(contact.body1, contact.body2);
      for (double& component : contact.force) {
        component = -component;
      }
      if (!between(contact, request.body1, request.body2)) {
        continue;
      }
    }
    append(contact, response);
  }
}

}  // namespace

SimServices::SimServices(ros::NodeHandle node, Simulation& simulation)
    : simulation_(simulation), services_(std::move(node)) {
  offerTime();
  offerRobots();
  offerBodies();
  offerStates();
  offerWorld();
  offerGazebo();
}

void SimServices::offerTime() {
  services_.offerEmpty("pause_physics", [this](const auto&) { simulation_.setPaused(true); });
  services_.offerEmpty("unpause_physics", [this](const auto&) { simulation_.setPaused(false); });
  services_.offer<Step>("step", [this](Step::Request& request, Step::Response& response) {
    fill(simulation_.step(request.ticks), response);
  });
  services_.offer<SetRealTimeFactor>(
      "set_real_time_factor",
      [this](SetRealTimeFactor::Request& request, SetRealTimeFactor::Response& /*response*/) {
        simulation_.setRealTimeFactor(request.real_time_factor);
      });
  services_.offer<std_srvs::Trigger>(
      "reset", [this](std_srvs::Trigger::Request& /*request*/,
                      std_srvs::Trigger::Response& /*response*/) { simulation_.reset(); });
  services_.offer<Benchmark>(
      "benchmark", [this](Benchmark::Request& request, Benchmark::Response& response) {
        const Simulation::Benchmark result = simulation_.benchmark(request.ticks);
        response.tick_us = result.tick;
        response.physics_us = result.physics;
        response.read_us = result.read;
        response.update_us = result.update;
        response.write_us = result.write;
        response.bare_us = result.bare;
      });
}

void SimServices::offerRobots() {
  services_.offer<SpawnRobot>("spawn_robot",
                              [this](SpawnRobot::Request& request, SpawnRobot::Response& response) {
                                response.warning = simulation_.robots().spawn(toOrder(request));
                              });
  services_.offer<DeleteRobot>(
      "delete_robot", [this](DeleteRobot::Request& request, DeleteRobot::Response& /*response*/) {
        simulation_.robots().remove(request.name);
      });
}

void SimServices::offerBodies() {
  services_.offer<GetBodyPose>(
      "get_body_pose", [this](GetBodyPose::Request& request, GetBodyPose::Response& response) {
        simulation_.withWorld([&](franka_sim::World& world) {
          response.pose = toMessage(bodyPose(world, request.body));
        });
      });
  services_.offer<SetBodyPose>(
      "set_body_pose", [this](SetBodyPose::Request& request, SetBodyPose::Response& /*response*/) {
        const franka_sim::Pose pose = fromMessage(request.pose);
        simulation_.withWorld(
            [&](franka_sim::World& world) { setBodyPose(world, request.body, pose); });
      });
  services_.offer<PushBody>(
      "push_body", [this](PushBody::Request& request, PushBody::Response& /*response*/) {
        simulation_.withWorld([&](franka_sim::World& world) { push(world, request); });
      });
  services_.offer<GetContacts>(
      "get_contacts", [this](GetContacts::Request& request, GetContacts::Response& response) {
        simulation_.withWorld(
            [&](franka_sim::World& world) { collectContacts(world, request, response); });
      });
}

}  // namespace franka_sim_mujoco
