// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// SimServices: Gazebo's services for forces and for the properties of physics, links and joints.
/// What a running simulation cannot change is refused with a sentence.

#include <franka_core/numbers.h>
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/pose_conversions.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_gravity.h>
#include <franka_sim/physics/world_models.h>
#include <franka_sim/physics/world_pushes.h>
#include <gazebo_msgs/ApplyBodyWrench.h>
#include <gazebo_msgs/ApplyJointEffort.h>
#include <gazebo_msgs/BodyRequest.h>
#include <gazebo_msgs/GetLinkProperties.h>
#include <gazebo_msgs/GetPhysicsProperties.h>
#include <gazebo_msgs/JointRequest.h>
#include <gazebo_msgs/SetJointProperties.h>
#include <gazebo_msgs/SetLinkProperties.h>
#include <gazebo_msgs/SetPhysicsProperties.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "gazebo_models.h"
#include "pace.h"
#include "sim_messages.h"
#include "sim_services.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

using franka_sim::World;

void describePhysics(Simulation& simulation,
                     gazebo_msgs::GetPhysicsProperties::Response& response) {
  const SimulationInventory inventory = simulation.inventory();
  response.time_step = World::kTick;
  response.pause = inventory.paused;
  response.max_update_rate = inventory.real_time_factor / World::kTick;
  response.gravity = toVector(inventory.gravity);
}

/// The settings of ODE have no counterpart and are not read.
/// @returns a note for the user if there are robots that compensate another gravity now
std::string setPhysics(Simulation& simulation,
                       const gazebo_msgs::SetPhysicsProperties::Request& request) {
  if (!(std::abs(request.time_step - World::kTick) < 1e-9)) {
    throw std::runtime_error("The time step is " + franka_core::numberText(World::kTick) +
                             " s and not " + franka_core::numberText(request.time_step) +
                             " s: robots and their controllers run at 1 kHz. Nothing was changed.");
  }
  const double factor = request.max_update_rate * World::kTick;
  paceOf(factor);  // throws for a wrong one, before anything changes
  const auto gravity = fromMessage(request.gravity);
  bool robots_differ = false;
  simulation.withWorld([&](World& world) {
    robots_differ = franka_sim::gravity(world) != gravity && !world.robots().empty();
    setGravity(world, gravity);
  });
  simulation.setRealTimeFactor(factor);
  return robots_differ
             ? "Robots go on compensating the gravity with which they were spawned: spawn them "
               "again to let them know of the new one."
             : "";
}

/// The duration of a force [ticks]. @throws std::runtime_error if it begins later
std::uint64_t ticksOf(Simulation& simulation, ros::Time start, ros::Duration duration) {
  if (start > simulation.state().time) {
    throw std::runtime_error(
        "start_time is in the future of the simulated time; forces begin at once: call again then, "
        "or set it to 0.");
  }
  const double ticks = std::max(1.0, std::round(duration.toSec() / World::kTick));
  return duration < ros::Duration(0) ? franka_sim::sizes::kEndlessPush
                                     : static_cast<std::uint64_t>(ticks);
}

/// Wrench and point are along the axes of the reference frame; in the world's frame the point 0 0
/// 0, the message's default, is the link's origin.
void applyWrench(Simulation& simulation, const gazebo_msgs::ApplyBodyWrench::Request& request) {
  const std::uint64_t duration = ticksOf(simulation, request.start_time, request.duration);
  const Eigen::Vector3d given_force = franka_sim::vector(fromMessage(request.wrench.force));
  const Eigen::Vector3d given_torque = franka_sim::vector(fromMessage(request.wrench.torque));
  const auto& point = request.reference_point;
  checkFinite({point.x, point.y, point.z}, "reference_point");
  simulation.withWorld([&](World& world) {
    const GazeboModels models(world);
    const std::string body = models.body(request.body_name);
    const Eigen::Vector3d origin = franka_sim::vector(bodyPose(world, body).position);
    const franka_sim::BodyState at_point{{{point.x, point.y, point.z}, {1, 0, 0, 0}}, {}};
    const franka_sim::BodyState in_world = models.toWorld(at_point, request.reference_frame);
    const Eigen::Matrix3d turn = franka_sim::toIsometry(in_world.pose).linear();
    const Eigen::Vector3d force = turn * given_force;
    Eigen::Vector3d torque = turn * given_torque;
    if (!GazeboModels::isWorld(request.reference_frame) ||
        in_world.pose.position != std::array<double, 3>{}) {
      torque += (franka_sim::vector(in_world.pose.position) - origin).cross(force);
    }
    pushBody(world, body, franka_sim::array(force), franka_sim::array(torque), duration);
  });
}

void clearWrenches(Simulation& simulation, const std::string& name) {
  simulation.withWorld(
      [&](World& world) { franka_sim::endPushes(world, GazeboModels(world).body(name)); });
}

void applyEffort(Simulation& simulation, const gazebo_msgs::ApplyJointEffort::Request& request) {
  const std::uint64_t duration = ticksOf(simulation, request.start_time, request.duration);
  simulation.withWorld([&](World& world) {
    pushJoint(world, GazeboModels(world).joint(request.joint_name).name, request.effort, duration);
  });
}

void clearEfforts(Simulation& simulation, const std::string& name) {
  simulation.withWorld(
      [&](World& world) { endJointPushes(world, GazeboModels(world).joint(name).name); });
}

void describeLink(Simulation& simulation, const std::string& name,
                  gazebo_msgs::GetLinkProperties::Response& response) {
  simulation.withWorld([&](World& world) {
    const franka_sim::BodyInertia body = bodyInertia(world, GazeboModels(world).body(name));
    response.com.position = toPoint(body.center);
    response.com.orientation.w = 1;
    response.gravity_mode = body.gravity;
    response.mass = body.mass;
    response.ixx = body.inertia[0];
    response.ixy = body.inertia[1];
    response.ixz = body.inertia[2];
    response.iyy = body.inertia[3];
    response.iyz = body.inertia[4];
    response.izz = body.inertia[5];
  });
}

/// @throws std::runtime_error always
void refuseForLink(Simulation& simulation, const std::string& name) {
  simulation.withWorld([&](World& world) { GazeboModels(world).body(name); });
  throw std::runtime_error("The properties of link '" + name +
                           "' cannot be changed while the simulation runs: change them in its URDF "
                           "or SDF, then delete and spawn the model again.");
}

void refuseForJoint(Simulation& simulation, const std::string& name, const std::string& advice) {
  simulation.withWorld([&](World& world) { GazeboModels(world).joint(name); });
  throw std::runtime_error("Joint '" + name + "': " + advice);
}

}  // namespace

void SimServices::offerGazeboPhysics() {
  using gazebo_msgs::ApplyBodyWrench;
  using gazebo_msgs::ApplyJointEffort;
  using gazebo_msgs::BodyRequest;
  using gazebo_msgs::GetLinkProperties;
  using gazebo_msgs::GetPhysicsProperties;
  using gazebo_msgs::JointRequest;
  using gazebo_msgs::SetJointProperties;
  using gazebo_msgs::SetLinkProperties;
  using gazebo_msgs::SetPhysicsProperties;
  services_.offer<GetPhysicsProperties>(
      "get_physics_properties",
      [this](GetPhysicsProperties::Request&, GetPhysicsProperties::Response& response) {
        describePhysics(simulation_, response);
      });
  services_.offer<SetPhysicsProperties>(
      "set_physics_properties",
      [this](SetPhysicsProperties::Request& request, SetPhysicsProperties::Response& response) {
        response.status_message = setPhysics(simulation_, request);
      });
  services_.offer<ApplyBodyWrench>(
      "apply_body_wrench", [this](ApplyBodyWrench::Request& request, ApplyBodyWrench::Response&) {
        applyWrench(simulation_, request);
      });
  services_.offerEmpty<BodyRequest>("clear_body_wrenches",
                                    [this](const BodyRequest::Request& request) {
                                      clearWrenches(simulation_, request.body_name);
                                    });
  services_.offer<GetLinkProperties>(
      "get_link_properties",
      [this](GetLinkProperties::Request& request, GetLinkProperties::Response& response) {
        describeLink(simulation_, request.link_name, response);
      });
  services_.offer<SetLinkProperties>(
      "set_link_properties",
      [this](SetLinkProperties::Request& request, SetLinkProperties::Response&) {
        refuseForLink(simulation_, request.link_name);
      });
  services_.offer<SetJointProperties>(
      "set_joint_properties",
      [this](SetJointProperties::Request& request, SetJointProperties::Response&) {
        refuseForJoint(simulation_, request.joint_name,
                       "its properties cannot be changed while the simulation runs: change them in "
                       "its URDF or SDF, then delete and spawn the model again.");
      });
  services_.offer<ApplyJointEffort>("apply_joint_effort", [this](ApplyJointEffort::Request& request,
                                                                 ApplyJointEffort::Response&) {
    applyEffort(simulation_, request);
  });
  services_.offerEmpty<JointRequest>("clear_joint_forces",
                                     [this](const JointRequest::Request& request) {
                                       clearEfforts(simulation_, request.joint_name);
                                     });
}

}  // namespace franka_sim_mujoco
