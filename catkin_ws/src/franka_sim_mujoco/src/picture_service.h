// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/renderer.h>
#include <franka_sim_mujoco/RenderPicture.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <memory>
#include <thread>

namespace franka_sim_mujoco {

class Simulation;

/// The service that draws pictures. Has its own thread: the stepping thread only copies the scene,
/// and a renderer belongs to one thread. The renderer is created for the first picture, because it
/// takes memory (decision 38).
class PictureService {
 public:
  /// @param node its namespace contains `render_picture`
  PictureService(ros::NodeHandle node, Simulation& simulation);
  ~PictureService();
  PictureService(const PictureService&) = delete;
  PictureService& operator=(const PictureService&) = delete;

 private:
  void loop();
  bool render(RenderPicture::Request& request, RenderPicture::Response& response);

  Simulation& simulation_;
  ros::CallbackQueue queue_;
  ros::ServiceServer server_;
  std::unique_ptr<franka_sim::Renderer> renderer_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace franka_sim_mujoco
