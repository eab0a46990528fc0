// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <functional>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

class Simulation;

/// The simulation's services: time (pause, step, factor, reset), robots (spawn, delete), things
/// (poses, pushes, contacts), benchmark. Each answers success=false and a sentence instead of
/// failing the call. They have threads of their own, so that a controller switch that waits for a
/// paused simulation cannot keep anyone from unpausing it.
class SimServices {
 public:
  /// @param node in whose namespace they are offered; pause_physics and unpause_physics too
  SimServices(ros::NodeHandle node, Simulation& simulation);
  ~SimServices();
  SimServices(const SimServices&) = delete;
  SimServices& operator=(const SimServices&) = delete;

 private:
  template <typename Service>
  void offer(const std::string& name,
             std::function<void(typename Service::Request&, typename Service::Response&)> handler);
  void offerEmpty(const std::string& name, std::function<void()> action);
  void offerTime();
  void offerRobots();
  void offerBodies();

  ros::NodeHandle node_;
  Simulation& simulation_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  ros::AsyncSpinner spinner_;
};

}  // namespace franka_sim_mujoco
