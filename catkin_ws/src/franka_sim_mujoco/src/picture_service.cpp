// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "picture_service.h"

#include <ros/advertise_service_options.h>
#include <sensor_msgs/image_encodings.h>

#include <cmath>
#include <stdexcept>

#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

constexpr std::uint32_t kDefaultWidth = 640, kDefaultHeight = 480;
constexpr std::uint32_t kMaxSide = 4096;

franka_sim::Camera toCamera(const RenderPicture::Request& request) {
  franka_sim::Camera camera;
  camera.position = {request.position.x, request.position.y, request.position.z};
  camera.target = {request.target.x, request.target.y, request.target.z};
  if (request.field_of_view != 0.0) {
    camera.field_of_view = request.field_of_view;
  }
  double distance = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    distance = std::max(distance, std::abs(camera.position[i] - camera.target[i]));
    if (!std::isfinite(camera.position[i]) || !std::isfinite(camera.target[i])) {
      throw std::runtime_error("The camera's position and target must be finite numbers.");
    }
  }
  if (distance < 1e-6) {
    throw std::runtime_error("The camera is at its target point: move one of them.");
  }
  if (!(camera.field_of_view > 0.0 && camera.field_of_view < 180.0)) {
    throw std::runtime_error("The field of view must lie between 0 and 180 degrees.");
  }
  return camera;
}

}  // namespace

PictureService::PictureService(ros::NodeHandle node, Simulation& simulation)
    : simulation_(simulation) {
  auto options = ros::AdvertiseServiceOptions::create<RenderPicture>(
      "render_picture",
      [this](RenderPicture::Request& request, RenderPicture::Response& response) {
        return render(request, response);
      },
      ros::VoidConstPtr(), &queue_);
  server_ = node.advertiseService(options);
  thread_ = std::thread([this] { loop(); });
}

PictureService::~PictureService() {
  stop_ = true;
  server_.shutdown();
  queue_.disable();
  thread_.join();
}

void PictureService::loop() {
  while (!stop_) {
    queue_.callAvailable(ros::WallDuration(0.1));
  }
  renderer_.reset();
}

bool PictureService::render(RenderPicture::Request& request, RenderPicture::Response& response) {
  try {
    const std::uint32_t width = request.width == 0 ? kDefaultWidth : request.width;
    const std::uint32_t height = request.height == 0 ? kDefaultHeight : request.height;
    if (width > kMaxSide || height > kMaxSide) {
      throw std::runtime_error("A picture may be at most " + std::to_string(kMaxSide) +
                               " pixels wide and high.");
    }
    const franka_sim::Camera camera = toCamera(request);
    if (!renderer_) {
      renderer_ = std::make_unique<franka_sim::Renderer>();
    }
    franka_sim::Scene scene;
    ros::Time stamp;
    simulation_.withWorld([&](franka_sim::World& world) {
      scene = franka_sim::captureScene(world);
      stamp = simulation_.state().time;
    });
    const franka_sim::Picture picture =
        renderer_->render(scene, camera, static_cast<int>(width), static_cast<int>(height));
    response.image.header.stamp = stamp;
    response.image.header.frame_id = "world";
    response.image.width = static_cast<std::uint32_t>(picture.width);
    response.image.height = static_cast<std::uint32_t>(picture.height);
    response.image.encoding = sensor_msgs::image_encodings::RGB8;
    response.image.step = response.image.width * 3;
    response.image.data = picture.rgb;
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.error = error.what();
  }
  return true;
}

}  // namespace franka_sim_mujoco
