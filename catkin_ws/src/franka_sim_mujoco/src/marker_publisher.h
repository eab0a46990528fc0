// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world_shapes.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <visualization_msgs/MarkerArray.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace franka_sim_mujoco {

class Simulation;

/// Publishes the shapes of the world's objects on `markers`, latched, for rviz: all of them
/// whenever one moved, came or went, at most 20 times a wall second, while there are subscribers.
/// Robots are left out: rviz draws them from their descriptions. Has its own thread: the stepping
/// thread only copies the scene.
class MarkerPublisher {
 public:
  /// @param node in whose namespace `markers` is advertised
  MarkerPublisher(ros::NodeHandle node, Simulation& simulation);
  ~MarkerPublisher();
  MarkerPublisher(const MarkerPublisher&) = delete;
  MarkerPublisher& operator=(const MarkerPublisher&) = delete;

 private:
  void loop();
  void publish();
  bool hasMoved(const std::vector<franka_sim::Pose>& poses) const;

  Simulation& simulation_;
  ros::Publisher publisher_;
  bool drawn_{false};  ///< since there are subscribers
  std::uint64_t generation_{0};
  franka_sim::WorldShapes objects_;
  std::vector<franka_sim::Pose> published_;  ///< see franka_sim::framePoses
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The markers of these shapes in frame `world`, after one that deletes all earlier ones. Endless
/// planes are left out; a capsule is a cylinder and two spheres.
/// @param poses of the bodies in `shapes`
visualization_msgs::MarkerArray markersOf(const franka_sim::WorldShapes& shapes,
                                          const std::vector<franka_sim::Pose>& poses);

}  // namespace franka_sim_mujoco
