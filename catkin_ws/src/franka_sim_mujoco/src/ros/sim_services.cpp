// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/Benchmark.h>
#include <franka_sim_mujoco/DeleteRobot.h>
#include <franka_sim_mujoco/GetBodyPose.h>
#include <franka_sim_mujoco/GetContacts.h>
#include <franka_sim_mujoco/PushBody.h>
#include <franka_sim_mujoco/SetBodyPose.h>
#include <franka_sim_mujoco/SetRealTimeFactor.h>
#include <franka_sim_mujoco/SpawnRobot.h>
#include <franka_sim_mujoco/Step.h>
#include <franka_sim_mujoco/ros/sim_services.h>
#include <franka_sim_mujoco/ros/simulation.h>
#include <ros/advertise_service_options.h>
#include <ros/console.h>
#include <std_srvs/Empty.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace franka_sim_mujoco {

namespace {

constexpr char kLog[] = "franka_sim_mujoco";
/// Some wait (step, spawn); the others must get through beside them.
constexpr std::uint32_t kThreads = 3;

template <typename Response>
void setText(Response& response, const char* text) {
  response.error = text;
}
void setText(std_srvs::Trigger::Response& response, const char* text) { response.message = text; }

void checkFinite(std::initializer_list<double> numbers, const char* what) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      throw std::runtime_error(std::string("The ") + what + " must be made of finite numbers.");
    }
  }
}

Pose fromMessage(const geometry_msgs::Pose& message) {
  Pose pose;
  pose.position = {message.position.x, message.position.y, message.position.z};
  std::array<double, 4>& q = pose.orientation;
  q = {message.orientation.w, message.orientation.x, message.orientation.y, message.orientation.z};
  checkFinite({pose.position[0], pose.position[1], pose.position[2], q[0], q[1], q[2], q[3]},
              "pose");
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (std::abs(norm - 1.0) > 1e-3) {
    throw std::runtime_error("The orientation must be a unit quaternion; its length is " +
                             std::to_string(norm) + ".");
  }
  for (double& entry : q) {
    entry /= norm;
  }
  return pose;
}

geometry_msgs::Pose toMessage(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.position[0];
  message.position.y = pose.position[1];
  message.position.z = pose.position[2];
  message.orientation.w = pose.orientation[0];
  message.orientation.x = pose.orientation[1];
  message.orientation.y = pose.orientation[2];
  message.orientation.z = pose.orientation[3];
  return message;
}

SpawnOrder fromMessage(const SpawnRobot::Request& request) {
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

void push(World& world, const PushBody::Request& request) {
  const std::array<double, 3> force{request.force.x, request.force.y, request.force.z};
  const std::array<double, 3> torque{request.torque.x, request.torque.y, request.torque.z};
  checkFinite({force[0], force[1], force[2], torque[0], torque[1], torque[2], request.point.x,
               request.point.y, request.point.z},
              "push");
  if (!request.at_point) {
    world.push(request.body, force, torque, request.ticks);
    return;
  }
  if (torque != std::array<double, 3>{}) {
    throw std::runtime_error("A push at a point takes no torque: push the body itself for that.");
  }
  world.pushAt(request.body, {request.point.x, request.point.y, request.point.z}, force,
               request.ticks);
}

bool between(const Contact& contact, const std::string& body1, const std::string& body2) {
  const auto matches = [](const std::string& wanted, const std::string& body) {
    return wanted.empty() || wanted == body;
  };
  return matches(body1, contact.body1) && matches(body2, contact.body2);
}

/// Forces are told as acting on the second body asked for, whichever order the physics has them in.
void collectContacts(World& world, const GetContacts::Request& request,
                     GetContacts::Response& response) {
  for (const std::string& body : {request.body1, request.body2}) {
    if (!body.empty()) {
      world.bodyPose(body);  // throws the sentence for a body that does not exist
    }
  }
  for (Contact contact : world.contacts()) {
    if (!between(contact, request.body1, request.body2)) {
      std::swap(contact.body1, contact.body2);
      for (double& component : contact.force) {
        component = -component;
      }
      if (!between(contact, request.body1, request.body2)) {
        continue;
      }
    }
    response.body1s.push_back(contact.body1);
    response.body2s.push_back(contact.body2);
    geometry_msgs::Point position;
    position.x = contact.position[0];
    position.y = contact.position[1];
    position.z = contact.position[2];
    response.positions.push_back(position);
    geometry_msgs::Vector3 force;
    force.x = contact.force[0];
    force.y = contact.force[1];
    force.z = contact.force[2];
    response.forces.push_back(force);
  }
}

}  // namespace

SimServices::SimServices(ros::NodeHandle node, Simulation& simulation)
    : node_(std::move(node)), simulation_(simulation), spinner_(kThreads, &queue_) {
  offerTime();
  offerRobots();
  offerBodies();
  spinner_.start();
}

SimServices::~SimServices() {
  for (ros::ServiceServer& server : servers_) {
    server.shutdown();
  }
  queue_.disable();
  spinner_.stop();
}

template <typename Service>
void SimServices::offer(
    const std::string& name,
    std::function<void(typename Service::Request&, typename Service::Response&)> handler) {
  auto options = ros::AdvertiseServiceOptions::create<Service>(
      name,
      [handler, name](typename Service::Request& request, typename Service::Response& response) {
        try {
          handler(request, response);
          response.success = true;
        } catch (const std::exception& error) {
          ROS_WARN_NAMED(kLog, "%s: %s", name.c_str(), error.what());
          response = typename Service::Response();
          response.success = false;
          setText(response, error.what());
        }
        return true;
      },
      ros::VoidConstPtr(), &queue_);
  servers_.push_back(node_.advertiseService(options));
}

void SimServices::offerEmpty(const std::string& name, std::function<void()> action) {
  auto options = ros::AdvertiseServiceOptions::create<std_srvs::Empty>(
      name,
      [action, name](std_srvs::Empty::Request& /*request*/,
                     std_srvs::Empty::Response& /*response*/) {
        try {
          action();
          return true;
        } catch (const std::exception& error) {
          ROS_ERROR_NAMED(kLog, "%s: %s", name.c_str(), error.what());
          return false;
        }
      },
      ros::VoidConstPtr(), &queue_);
  servers_.push_back(node_.advertiseService(options));
}

void SimServices::offerTime() {
  offerEmpty("pause_physics", [this] { simulation_.setPaused(true); });
  offerEmpty("unpause_physics", [this] { simulation_.setPaused(false); });
  offer<Step>("step", [this](Step::Request& request, Step::Response& response) {
    fill(simulation_.step(request.ticks), response);
  });
  offer<SetRealTimeFactor>(
      "set_real_time_factor",
      [this](SetRealTimeFactor::Request& request, SetRealTimeFactor::Response& /*response*/) {
        simulation_.setRealTimeFactor(request.real_time_factor);
      });
  offer<std_srvs::Trigger>(
      "reset", [this](std_srvs::Trigger::Request& /*request*/,
                      std_srvs::Trigger::Response& /*response*/) { simulation_.reset(); });
  offer<Benchmark>("benchmark", [this](Benchmark::Request& request, Benchmark::Response& response) {
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
  offer<SpawnRobot>("spawn_robot",
                    [this](SpawnRobot::Request& request, SpawnRobot::Response& /*response*/) {
                      simulation_.spawn(fromMessage(request));
                    });
  offer<DeleteRobot>("delete_robot",
                     [this](DeleteRobot::Request& request, DeleteRobot::Response& /*response*/) {
                       simulation_.remove(request.name);
                     });
}

void SimServices::offerBodies() {
  offer<GetBodyPose>(
      "get_body_pose", [this](GetBodyPose::Request& request, GetBodyPose::Response& response) {
        simulation_.withWorld(
            [&](World& world) { response.pose = toMessage(world.bodyPose(request.body)); });
      });
  offer<SetBodyPose>(
      "set_body_pose", [this](SetBodyPose::Request& request, SetBodyPose::Response& /*response*/) {
        const Pose pose = fromMessage(request.pose);
        simulation_.withWorld([&](World& world) { world.setBodyPose(request.body, pose); });
      });
  offer<PushBody>("push_body",
                  [this](PushBody::Request& request, PushBody::Response& /*response*/) {
                    simulation_.withWorld([&](World& world) { push(world, request); });
                  });
  offer<GetContacts>(
      "get_contacts", [this](GetContacts::Request& request, GetContacts::Response& response) {
        simulation_.withWorld([&](World& world) { collectContacts(world, request, response); });
      });
}

}  // namespace franka_sim_mujoco
