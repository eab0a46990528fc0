// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gazebo_msgs/LinkStates.h>
#include <gazebo_msgs/ModelStates.h>
#include <ros/console.h>

#include <chrono>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "gazebo_models.h"
#include "sim_messages.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

constexpr std::chrono::milliseconds kTopicInterval{10};

/// ModelStates and LinkStates have the same fields.
template <typename Message>
void append(const std::string& name, const franka_sim::BodyState& state, Message& message) {
  message.name.push_back(name);
  message.pose.push_back(toMessage(state.pose));
  message.twist.push_back(toMessage(state.twist));
}

/// Topics have no answer, so errors are logged.
void orWarn(const char* topic, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    ROS_WARN_THROTTLE_NAMED(10.0, "franka_sim_mujoco", "%s: %s", topic, error.what());
  }
}

}  // namespace

GazeboTopics::GazeboTopics(ros::NodeHandle node, Simulation& simulation)
    : simulation_(simulation),
      models_(node.advertise<gazebo_msgs::ModelStates>("model_states", 1)),
      links_(node.advertise<gazebo_msgs::LinkStates>("link_states", 1)) {
  const boost::function<void(const gazebo_msgs::ModelState&)> set_model =
      [this](const gazebo_msgs::ModelState& state) {
        orWarn("set_model_state", [&] { place(simulation_, state); });
      };
  const boost::function<void(const gazebo_msgs::LinkState&)> set_link =
      [this](const gazebo_msgs::LinkState& state) {
        orWarn("set_link_state", [&] { place(simulation_, state); });
      };
  set_model_ = node.subscribe<gazebo_msgs::ModelState>("set_model_state", 10, set_model);
  set_link_ = node.subscribe<gazebo_msgs::LinkState>("set_link_state", 10, set_link);
  thread_ = std::thread([this] { loop(); });
}

GazeboTopics::~GazeboTopics() {
  set_model_.shutdown();
  set_link_.shutdown();
  stop_ = true;
  thread_.join();
}

void GazeboTopics::loop() {
  while (!stop_) {
    std::this_thread::sleep_for(kTopicInterval);
    if (models_.getNumSubscribers() > 0) {
      orWarn("model_states", [this] { publishModels(); });
    }
    if (links_.getNumSubscribers() > 0) {
      orWarn("link_states", [this] { publishLinks(); });
    }
  }
}

void GazeboTopics::publishModels() {
  gazebo_msgs::ModelStates message;
  simulation_.withWorld([&](franka_sim::World& world) {
    std::vector<std::string> names, bodies;
    for (const franka_sim::WorldModel& model : models(world)) {
      names.push_back(model.name);
      bodies.push_back(model.body);
    }
    const std::vector<franka_sim::BodyState> states = bodyStates(world, bodies);
    for (std::size_t i = 0; i < names.size(); ++i) {
      append(names[i], states[i], message);
    }
  });
  models_.publish(message);
}

void GazeboTopics::publishLinks() {
  gazebo_msgs::LinkStates message;
  simulation_.withWorld([&](franka_sim::World& world) {
    std::vector<std::string> names, bodies;
    for (const franka_sim::WorldModel& model : models(world)) {
      for (const std::string& link : model.links) {
        names.push_back(GazeboModels::linkName(model, link));
        bodies.push_back(link);
      }
    }
    const std::vector<franka_sim::BodyState> states = bodyStates(world, bodies);
    for (std::size_t i = 0; i < names.size(); ++i) {
      append(names[i], states[i], message);
    }
  });
  links_.publish(message);
}

}  // namespace franka_sim_mujoco
