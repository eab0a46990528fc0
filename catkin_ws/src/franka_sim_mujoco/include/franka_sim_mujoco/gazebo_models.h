// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <gazebo_msgs/LinkState.h>
#include <gazebo_msgs/ModelState.h>
#include <geometry_msgs/Pose.h>

#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// The models of a moment, found by Gazebo's names: those of models, of links, and model::link.
/// Stepping thread only, for one moment.
class GazeboModels {
 public:
  explicit GazeboModels(franka_sim::World& world) : world_(world), models_(world.models()) {}

  const std::vector<franka_sim::WorldModel>& all() const noexcept { return models_; }
  /// @throws std::runtime_error with a sentence for an unknown one
  const franka_sim::WorldModel& model(const std::string& name) const;
  /// The body that a model's or link's name means. @throws std::runtime_error with a sentence
  std::string body(const std::string& name) const;
  /// "model::link"
  static std::string linkName(const franka_sim::WorldModel& model, const std::string& link);

  /// @name Between the world's frame and that of a model or link; empty, "world" or "map": none
  /// @throws std::runtime_error with a sentence for an unknown frame
  /// @{
  franka_sim::BodyState toFrame(const franka_sim::BodyState& in_world,
                                const std::string& frame) const;
  franka_sim::BodyState toWorld(const franka_sim::BodyState& in_frame,
                                const std::string& frame) const;
  /// @}

  /// Puts a model or link elsewhere and gives it a velocity. @param state in `frame`
  /// @throws std::runtime_error with a sentence: unknown, or not free to move
  void place(const std::string& name, const franka_sim::BodyState& state, const std::string& frame);

 private:
  franka_sim::World& world_;
  std::vector<franka_sim::WorldModel> models_;
};

class Simulation;

/// Does what a message of Gazebo says, between two ticks.
/// @throws std::runtime_error with a sentence: numbers that are not finite, and as GazeboModels
void place(Simulation& simulation, const gazebo_msgs::ModelState& state);
void place(Simulation& simulation, const gazebo_msgs::LinkState& state);

/// As fromMessage (sim_messages.h), but orientations of any length are taken, and 0 0 0 0, what a
/// message begins with, as none: Gazebo does so.
franka_sim::Pose fromGazebo(geometry_msgs::Pose message);

}  // namespace franka_sim_mujoco
