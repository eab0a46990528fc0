// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// SimServices: the most used services of Gazebo, with its names and types. Errors are reported in
/// status_message.

#include <franka_sim/physics/world_joints.h>
#include <gazebo_msgs/DeleteModel.h>
#include <gazebo_msgs/GetJointProperties.h>
#include <gazebo_msgs/GetLinkState.h>
#include <gazebo_msgs/GetModelProperties.h>
#include <gazebo_msgs/GetModelState.h>
#include <gazebo_msgs/GetWorldProperties.h>
#include <gazebo_msgs/SetJointTrajectory.h>
#include <gazebo_msgs/SetLinkState.h>
#include <gazebo_msgs/SetModelConfiguration.h>
#include <gazebo_msgs/SetModelState.h>
#include <gazebo_msgs/SpawnModel.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "gazebo_models.h"
#include "sim_messages.h"
#include "sim_services.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

using gazebo_msgs::GetJointProperties;

void readModelState(Simulation& simulation, const gazebo_msgs::GetModelState::Request& request,
                    gazebo_msgs::GetModelState::Response& response) {
  simulation.withWorld([&](franka_sim::World& world) {
    const GazeboModels models(world);
    const franka_sim::BodyState state = models.toFrame(
        bodyState(world, models.model(request.model_name).body), request.relative_entity_name);
    response.pose = toMessage(state.pose);
    response.twist = toMessage(state.twist);
  });
  response.header.frame_id = request.relative_entity_name;
  response.header.stamp = simulation.state().time;
}

void readLinkState(Simulation& simulation, const gazebo_msgs::GetLinkState::Request& request,
                   gazebo_msgs::LinkState& link) {
  simulation.withWorld([&](franka_sim::World& world) {
    const GazeboModels models(world);
    const franka_sim::BodyState state =
        models.toFrame(bodyState(world, models.body(request.link_name)), request.reference_frame);
    link.pose = toMessage(state.pose);
    link.twist = toMessage(state.twist);
  });
  link.link_name = request.link_name;
  link.reference_frame = request.reference_frame;
}

void describeJoint(Simulation& simulation, const std::string& name,
                   GetJointProperties::Response& response) {
  simulation.withWorld([&](franka_sim::World& world) {
    const GazeboModels models(world);
    const franka_sim::WorldJoint& joint = models.joint(name);
    const franka_sim::JointMeasurement measured = jointState(world, joint.name);
    response.type = joint.slides    ? GetJointProperties::Response::PRISMATIC
                    : joint.limited ? GetJointProperties::Response::REVOLUTE
                                    : GetJointProperties::Response::CONTINUOUS;
    response.damping = {joint.damping};
    response.position = {measured.position};
    response.rate = {measured.velocity};
  });
}

void describeModel(Simulation& simulation, const std::string& name,
                   gazebo_msgs::GetModelProperties::Response& response) {
  simulation.withWorld([&](franka_sim::World& world) {
    const GazeboModels models(world);
    const franka_sim::WorldModel& model = models.model(name);
    response.canonical_body_name = model.links.empty() ? "" : model.links.front();
    response.body_names = model.links;
    for (const franka_sim::WorldJoint& joint : model.joints) {
      response.joint_names.push_back(joint.name);
    }
    response.is_static = model.is_static;
  });
}

void deleteModel(Simulation& simulation, const std::string& name) {
  const SimulationInventory inventory = simulation.inventory();
  const auto has = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (has(inventory.robots)) {
    simulation.robots().remove(name);
  } else if (has(inventory.objects)) {
    simulation.robots().removeObject(name);
  } else if (has(inventory.bodies)) {
    throw std::runtime_error("'" + name +
                             "' belongs to the world file; only spawned models can be deleted.");
  } else {
    throw std::runtime_error("There is no model '" + name + "' in the simulated world.");
  }
}

franka_sim::Pose spawnPose(Simulation& simulation,
                           const gazebo_msgs::SpawnModel::Request& request) {
  franka_sim::Pose pose = fromGazebo(request.initial_pose);
  simulation.withWorld([&](franka_sim::World& world) {
    pose = GazeboModels(world).toWorld({pose, franka_sim::Twist{}}, request.reference_frame).pose;
  });
  return pose;
}

std::string spawnUrdf(Simulation& simulation, const gazebo_msgs::SpawnModel::Request& request) {
  SpawnOrder order;
  order.name = request.model_name;
  order.urdf = request.model_xml;
  order.robot_namespace = request.robot_namespace;
  order.pose = spawnPose(simulation, request);
  return simulation.robots().spawn(order);
}

/// Gazebo accepts a model's joints with or without the model's name as prefix.
void configure(Simulation& simulation, const gazebo_msgs::SetModelConfiguration::Request& request) {
  if (request.joint_names.size() != request.joint_positions.size()) {
    throw std::runtime_error("There are " + std::to_string(request.joint_names.size()) +
                             " joint names and " + std::to_string(request.joint_positions.size()) +
                             " positions; each joint needs one.");
  }
  std::vector<std::string> joints;
  simulation.withWorld([&](franka_sim::World& world) {
    const GazeboModels models(world);
    const franka_sim::WorldModel& model = models.model(request.model_name);
    for (const std::string& name : request.joint_names) {
      const auto found = std::find_if(
          model.joints.begin(), model.joints.end(), [&](const franka_sim::WorldJoint& joint) {
            return joint.name == name || GazeboModels::linkName(model, joint.name) == name;
          });
      if (found == model.joints.end()) {
        throw std::runtime_error("The model '" + model.name + "' has no joint '" + name +
                                 "' that moves.");
      }
      joints.push_back(found->name);
    }
  });
  simulation.robots().setJoints(joints, request.joint_positions,
                                std::vector<double>(joints.size(), 0.0));
}

}  // namespace

void SimServices::offerGazebo() {
  offerGazeboLights();
  offerGazeboStates();
  offerGazeboModels();
  offerGazeboPhysics();
  services_.offer<GetJointProperties>(
      "get_joint_properties",
      [this](GetJointProperties::Request& request, GetJointProperties::Response& response) {
        describeJoint(simulation_, request.joint_name, response);
      });
  using gazebo_msgs::GetWorldProperties;
  services_.offer<GetWorldProperties>(
      "get_world_properties",
      [this](GetWorldProperties::Request& /*request*/, GetWorldProperties::Response& response) {
        simulation_.withWorld([&](franka_sim::World& world) {
          for (const franka_sim::WorldModel& model : models(world)) {
            response.model_names.push_back(model.name);
          }
        });
        response.sim_time = simulation_.state().time.toSec();
        response.rendering_enabled = true;
      });
  for (const char* name : {"reset_world", "reset_simulation"}) {
    services_.offerEmpty(name, [this](const auto&) { simulation_.reset(); });
  }
}

void SimServices::offerGazeboStates() {
  using gazebo_msgs::GetLinkState;
  using gazebo_msgs::GetModelState;
  using gazebo_msgs::SetLinkState;
  using gazebo_msgs::SetModelState;
  services_.offer<GetModelState>("get_model_state", [this](GetModelState::Request& request,
                                                           GetModelState::Response& response) {
    readModelState(simulation_, request, response);
  });
  services_.offer<GetLinkState>(
      "get_link_state", [this](GetLinkState::Request& request, GetLinkState::Response& response) {
        readLinkState(simulation_, request, response.link_state);
      });
  services_.offer<SetModelState>("set_model_state",
                                 [this](SetModelState::Request& request, SetModelState::Response&) {
                                   place(simulation_, request.model_state);
                                 });
  services_.offer<SetLinkState>("set_link_state",
                                [this](SetLinkState::Request& request, SetLinkState::Response&) {
                                  place(simulation_, request.link_state);
                                });
}

void SimServices::offerGazeboModels() {
  using gazebo_msgs::DeleteModel;
  using gazebo_msgs::GetModelProperties;
  using gazebo_msgs::SetJointTrajectory;
  using gazebo_msgs::SetModelConfiguration;
  using gazebo_msgs::SpawnModel;
  services_.offer<GetModelProperties>(
      "get_model_properties",
      [this](GetModelProperties::Request& request, GetModelProperties::Response& response) {
        describeModel(simulation_, request.model_name, response);
      });
  services_.offer<DeleteModel>("delete_model",
                               [this](DeleteModel::Request& request, DeleteModel::Response&) {
                                 deleteModel(simulation_, request.model_name);
                               });
  services_.offer<SpawnModel>("spawn_urdf_model",
                              [this](SpawnModel::Request& request, SpawnModel::Response& response) {
                                response.status_message = spawnUrdf(simulation_, request);
                              });
  services_.offer<SpawnModel>(
      "spawn_sdf_model", [this](SpawnModel::Request& request, SpawnModel::Response& response) {
        response.status_message = simulation_.robots().spawnObject(
            request.model_name, request.model_xml, spawnPose(simulation_, request));
      });
  services_.offer<SetModelConfiguration>(
      "set_model_configuration",
      [this](SetModelConfiguration::Request& request, SetModelConfiguration::Response&) {
        configure(simulation_, request);
      });
  services_.offer<SetJointTrajectory>(
      "set_joint_trajectory",
      [this](SetJointTrajectory::Request& request, SetJointTrajectory::Response&) {
        simulation_.withWorld(
            [&](franka_sim::World& world) { GazeboModels(world).model(request.model_name); });
        throw std::runtime_error(
            "Joints are not moved without forces here: send the trajectory to the model's "
            "joint_trajectory_controller, or call set_model_configuration for each pose.");
      });
}

}  // namespace franka_sim_mujoco
