// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// SimServices: Gazebo's services for lights.

#include <franka_sim/physics/pose_conversions.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_lights.h>
#include <gazebo_msgs/DeleteLight.h>
#include <gazebo_msgs/GetLightProperties.h>
#include <gazebo_msgs/SetLightProperties.h>

#include <string>

#include "gazebo_models.h"
#include "sim_messages.h"
#include "sim_services.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

using franka_sim::World;
using franka_sim::WorldLight;

void describeLight(Simulation& simulation, const std::string& name,
                   gazebo_msgs::GetLightProperties::Response& response) {
  simulation.withWorld([&](World& world) {
    const WorldLight light = franka_sim::light(world, name);
    response.diffuse.r = static_cast<float>(light.diffuse[0]);
    response.diffuse.g = static_cast<float>(light.diffuse[1]);
    response.diffuse.b = static_cast<float>(light.diffuse[2]);
    response.diffuse.a = 1;
    response.attenuation_constant = light.attenuation[0];
    response.attenuation_linear = light.attenuation[1];
    response.attenuation_quadratic = light.attenuation[2];
  });
}

/// The pose is the request's, as in Gazebo. A direction of 0 0 0, the message's default, keeps the
/// light's own.
void changeLight(Simulation& simulation, const gazebo_msgs::SetLightProperties::Request& request) {
  const franka_sim::Pose pose = fromGazebo(request.pose);
  const Eigen::Vector3d along = franka_sim::vector(fromMessage(request.direction));
  simulation.withWorld([&](World& world) {
    WorldLight light = franka_sim::light(world, request.light_name);
    light.shadows = request.cast_shadows != 0;
    light.diffuse = {request.diffuse.r, request.diffuse.g, request.diffuse.b};
    light.specular = {request.specular.r, request.specular.g, request.specular.b};
    light.attenuation = {request.attenuation_constant, request.attenuation_linear,
                         request.attenuation_quadratic};
    light.position = pose.position;
    if (along != Eigen::Vector3d::Zero()) {
      light.direction = franka_sim::array(franka_sim::toIsometry(pose).linear() * along);
    }
    franka_sim::setLight(world, request.light_name, light);
  });
}

void removeLight(Simulation& simulation, const std::string& name) {
  simulation.withWorld([&](World& world) {
    WorldLight light = franka_sim::light(world, name);
    light.on = false;
    franka_sim::setLight(world, name, light);
  });
}

}  // namespace

void SimServices::offerGazeboLights() {
  using gazebo_msgs::DeleteLight;
  using gazebo_msgs::GetLightProperties;
  using gazebo_msgs::SetLightProperties;
  services_.offer<GetLightProperties>(
      "get_light_properties",
      [this](GetLightProperties::Request& request, GetLightProperties::Response& response) {
        describeLight(simulation_, request.light_name, response);
      });
  services_.offer<SetLightProperties>(
      "set_light_properties",
      [this](SetLightProperties::Request& request, SetLightProperties::Response&) {
        changeLight(simulation_, request);
      });
  services_.offer<DeleteLight>("delete_light",
                               [this](DeleteLight::Request& request, DeleteLight::Response&) {
                                 removeLight(simulation_, request.light_name);
                               });
}

}  // namespace franka_sim_mujoco
