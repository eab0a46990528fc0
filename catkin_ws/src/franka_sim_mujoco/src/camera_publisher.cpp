// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "camera_publisher.h"

#include <franka_sim/physics/world_cameras.h>
#include <ros/console.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/distortion_models.h>
#include <sensor_msgs/image_encodings.h>
#include <tf2_msgs/TFMessage.h>

#include <cctype>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>

#include "service_handlers.h"
#include "sim_messages.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

/// For the whole process, because this is its first advertisement of /tf, and roscpp has one queue
/// for a topic: transforms of robots wait in it, too (TransformPublisher).
constexpr std::uint32_t kTransformQueue = 1000;

constexpr std::chrono::milliseconds kIdleSleep{5};
/// Interval of the search for new cameras (of robots and objects), in idle sleeps.
constexpr int kLookInterval = 100;
constexpr double kDegree = 3.14159265358979323846 / 180;

sensor_msgs::Image imageMessage(const std_msgs::Header& header,
                                const franka_sim::Picture& picture) {
  sensor_msgs::Image image;
  image.header = header;
  image.width = static_cast<std::uint32_t>(picture.width);
  image.height = static_cast<std::uint32_t>(picture.height);
  image.encoding = sensor_msgs::image_encodings::RGB8;
  image.step = image.width * 3;
  image.data = picture.rgb;
  return image;
}

sensor_msgs::Image depthMessage(const std_msgs::Header& header,
                                const franka_sim::Picture& picture) {
  sensor_msgs::Image image;
  image.header = header;
  image.width = static_cast<std::uint32_t>(picture.width);
  image.height = static_cast<std::uint32_t>(picture.height);
  image.encoding = sensor_msgs::image_encodings::TYPE_32FC1;
  image.step = image.width * sizeof(float);
  image.data.resize(picture.depth.size() * sizeof(float));
  std::memcpy(image.data.data(), picture.depth.data(), image.data.size());
  return image;
}

geometry_msgs::TransformStamped transformOf(const std_msgs::Header& header,
                                            const franka_sim::Pose& pose) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = header.stamp;
  transform.header.frame_id = "world";
  transform.child_frame_id = header.frame_id;
  transform.transform.translation = toVector(pose.position);
  transform.transform.rotation = toMessage(pose).orientation;
  return transform;
}

}  // namespace

sensor_msgs::CameraInfo pinhole(int width, int height, double vertical_view_degrees) {
  sensor_msgs::CameraInfo info;
  info.width = static_cast<std::uint32_t>(width);
  info.height = static_cast<std::uint32_t>(height);
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(5, 0.0);
  const double focus = 0.5 * height / std::tan(0.5 * vertical_view_degrees * kDegree);
  const double u = 0.5 * width, v = 0.5 * height;
  info.K = {focus, 0, u, 0, focus, v, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {focus, 0, u, 0, 0, focus, v, 0, 0, 0, 1, 0};
  return info;
}

std::string topicOf(const std::string& camera) {
  std::string topic;
  for (std::size_t i = 0; i < camera.size(); ++i) {
    if (camera.compare(i, 2, "::") == 0) {
      topic += '/';
      ++i;
    } else {
      const bool plain = std::isalnum(static_cast<unsigned char>(camera[i])) != 0;
      topic += plain || camera[i] == '/' ? camera[i] : '_';
    }
  }
  const bool starts_well =
      !topic.empty() && std::isalpha(static_cast<unsigned char>(topic[0])) != 0;
  return starts_well ? topic : "camera_" + topic;
}

bool CameraPublisher::Topics::hasSubscribers() const {
  return image.getNumSubscribers() > 0 || info.getNumSubscribers() > 0 ||
         depth.getNumSubscribers() > 0 || depth_info.getNumSubscribers() > 0;
}

CameraPublisher::CameraPublisher(ros::NodeHandle node, Simulation& simulation)
    : node_(std::move(node)),
      simulation_(simulation),
      transforms_(node_.advertise<tf2_msgs::TFMessage>("/tf", kTransformQueue)) {
  thread_ = std::thread([this] { loop(); });
}

CameraPublisher::~CameraPublisher() {
  stop_ = true;
  thread_.join();
}

void CameraPublisher::loop() {
  int naps = 0;
  while (!stop_) {
    try {
      if (naps++ % kLookInterval == 0) {
        std::vector<franka_sim::WorldCamera> present;
        simulation_.withWorld([&](franka_sim::World& world) { present = cameras(world); });
        follow(present);
      }
      for (auto& [name, topics] : cameras_) {
        if (!stop_ && topics.hasSubscribers()) {
          publish(&topics);
        }
      }
    } catch (const std::exception& error) {
      if (!stop_) {
        ROS_WARN_THROTTLE_NAMED(10.0, kLog, "No pictures are published: %s", error.what());
      }
    }
    std::this_thread::sleep_for(kIdleSleep);
  }
  renderer_.reset();
}

void CameraPublisher::follow(const std::vector<franka_sim::WorldCamera>& cameras) {
  std::map<std::string, Topics> present;
  for (const franka_sim::WorldCamera& camera : cameras) {
    const auto known = cameras_.find(camera.name);
    if (known != cameras_.end()) {
      present[camera.name] = known->second;
      continue;
    }
    const std::string topic = topicOf(camera.name);
    Topics& topics = present[camera.name];
    topics.camera = camera;
    topics.image = node_.advertise<sensor_msgs::Image>(topic + "/image_raw", 2);
    topics.info = node_.advertise<sensor_msgs::CameraInfo>(topic + "/camera_info", 2);
    topics.depth = node_.advertise<sensor_msgs::Image>(topic + "/depth/image_raw", 2);
    topics.depth_info = node_.advertise<sensor_msgs::CameraInfo>(topic + "/depth/camera_info", 2);
    ROS_INFO_STREAM_NAMED(kLog, "The pictures of camera '" << camera.name << "' are published on "
                                                           << topics.image.getTopic() << " and "
                                                           << topics.depth.getTopic() << ".");
  }
  cameras_.swap(present);
}

void CameraPublisher::publish(Topics* topics) {
  const franka_sim::WorldCamera& camera = topics->camera;
  const ros::Time now = simulation_.state().time;
  if (!topics->last.isZero() && (now - topics->last).toSec() < 1.0 / camera.rate - 5e-4) {
    return;
  }
  topics->last = now;
  if (!renderer_) {
    renderer_ = std::make_unique<franka_sim::Renderer>();
  }
  franka_sim::Scene scene;
  std_msgs::Header header;
  simulation_.withWorld([&](franka_sim::World& world) {
    scene = franka_sim::captureScene(world);
    header.stamp = simulation_.state().time;
  });
  header.frame_id = topicOf(camera.name) + "_optical_frame";
  const franka_sim::Picture picture =
      renderer_->render(scene, camera.name, camera.width, camera.height);
  tf2_msgs::TFMessage transforms;
  transforms.transforms.push_back(transformOf(header, picture.camera));
  transforms_.publish(transforms);
  sensor_msgs::CameraInfo info = pinhole(camera.width, camera.height, camera.field_of_view);
  info.header = header;
  topics->info.publish(info);
  topics->depth_info.publish(info);
  topics->image.publish(imageMessage(header, picture));
  if (topics->depth.getNumSubscribers() > 0) {
    topics->depth.publish(depthMessage(header, picture));
  }
}

}  // namespace franka_sim_mujoco
