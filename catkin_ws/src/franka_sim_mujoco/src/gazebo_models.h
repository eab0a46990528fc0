// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_models.h>
#include <gazebo_msgs/LinkState.h>
#include <gazebo_msgs/ModelState.h>
#include <geometry_msgs/Pose.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/subscriber.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace franka_sim_mujoco {

/// The models at one moment, found by Gazebo's names: those of models, of links, and model::link.
/// Stepping thread only; valid between two ticks.
class GazeboModels {
 public:
  explicit GazeboModels(franka_sim::World& world) : world_(world), models_(models(world)) {}

  const std::vector<franka_sim::WorldModel>& all() const noexcept { return models_; }
  /// @throws std::runtime_error with a sentence for an unknown name
  const franka_sim::WorldModel& model(const std::string& name) const;
  /// The body of a model's or link's name. @throws std::runtime_error with a sentence
  std::string body(const std::string& name) const;
  /// A joint that moves, by its name or model::joint. @throws std::runtime_error with a sentence
  const franka_sim::WorldJoint& joint(const std::string& name) const;
  /// Whether a frame is that of the world: empty, "world" or "map".
  static bool isWorld(const std::string& frame);
  /// "model::link"
  static std::string linkName(const franka_sim::WorldModel& model, const std::string& link);

  /// @name Conversions between the world's frame and that of a model or link; none for isWorld
  /// @throws std::runtime_error with a sentence for an unknown frame
  /// @{
  franka_sim::BodyState toFrame(const franka_sim::BodyState& in_world,
                                const std::string& frame) const;
  franka_sim::BodyState toWorld(const franka_sim::BodyState& in_frame,
                                const std::string& frame) const;
  /// @}

  /// Teleports a model or link and sets its velocity. @param state in `frame`
  /// @throws std::runtime_error with a sentence: unknown, or not free to move
  void place(const std::string& name, const franka_sim::BodyState& state, const std::string& frame);

 private:
  franka_sim::World& world_;
  std::vector<franka_sim::WorldModel> models_;
};

class Simulation;

/// Executes a message of Gazebo, between two ticks.
/// @throws std::runtime_error with a sentence: numbers that are not finite, and as GazeboModels
void place(Simulation& simulation, const gazebo_msgs::ModelState& state);
void place(Simulation& simulation, const gazebo_msgs::LinkState& state);

/// Like fromMessage (sim_messages.h), but orientations of any length are accepted, and 0 0 0 0, the
/// message's default, as the identity, as in Gazebo.
franka_sim::Pose fromGazebo(geometry_msgs::Pose message);

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
