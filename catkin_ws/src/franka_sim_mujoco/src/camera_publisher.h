// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/renderer.h>
#include <franka_sim/physics/world_cameras.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/CameraInfo.h>

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace franka_sim_mujoco {

class Simulation;

/// The intrinsics of a pinhole camera without distortion: square pixels, the principal point in the
/// middle of the picture.
sensor_msgs::CameraInfo pinhole(int width, int height, double vertical_view_degrees);

/// A camera's name as part of a topic: "::" and characters that ROS does not allow become "/" and
/// "_".
std::string topicOf(const std::string& camera);

/// Publishes the pictures of the world's named cameras (MJCF's <camera>, SDF's camera sensors)
/// while there are subscribers: `<camera>/image_raw` (rgb8), `<camera>/camera_info`,
/// `<camera>/depth/image_raw` (32FC1, [m], infinity for no hit), `<camera>/depth/camera_info`, and
/// the optical frame `<camera>_optical_frame` in `world` on /tf. Each camera has its own rate in
/// simulated time; a slow machine gives fewer pictures, not a slower simulation.
///
/// Has its own thread; the renderer is created for the first picture, because it takes memory
/// (decision 38).
class CameraPublisher {
 public:
  /// @param node its namespace contains the topics
  CameraPublisher(ros::NodeHandle node, Simulation& simulation);
  ~CameraPublisher();
  CameraPublisher(const CameraPublisher&) = delete;
  CameraPublisher& operator=(const CameraPublisher&) = delete;

 private:
  struct Topics {
    franka_sim::WorldCamera camera;
    ros::Publisher image, info, depth, depth_info;
    ros::Time last;
    bool hasSubscribers() const;
  };

  void loop();
  void follow(const std::vector<franka_sim::WorldCamera>& cameras);
  void publish(Topics* topics);

  ros::NodeHandle node_;
  Simulation& simulation_;
  ros::Publisher transforms_;
  std::map<std::string, Topics> cameras_;
  std::unique_ptr<franka_sim::Renderer> renderer_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace franka_sim_mujoco
