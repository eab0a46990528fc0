// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/LinkState.h>
#include <gazebo_msgs/ModelState.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <atomic>
#include <thread>

namespace franka_sim_mujoco {

class Simulation;

/// Gazebo's topics: publishes `model_states` and `link_states` 100 times a wall second while there
/// are subscribers, and subscribes to `set_model_state` and `set_link_state`. Has its own thread:
/// the stepping thread only copies the states.
class GazeboTopics {
 public:
  /// @param node its namespace contains the topics
  GazeboTopics(ros::NodeHandle node, Simulation& simulation);
  ~GazeboTopics();
  GazeboTopics(const GazeboTopics&) = delete;
  GazeboTopics& operator=(const GazeboTopics&) = delete;

 private:
  void loop();
  void publishModels();
  void publishLinks();

  Simulation& simulation_;
  ros::Publisher models_, links_;
  ros::Subscriber set_model_, set_link_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace franka_sim_mujoco
