// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/service_handlers.h>
#include <std_srvs/Empty.h>

#include <utility>

namespace franka_sim_mujoco {

namespace {

/// Some calls block (step, spawn); others must be served meanwhile.
constexpr std::uint32_t kThreads = 3;

}  // namespace

ServiceHandlers::ServiceHandlers(ros::NodeHandle node)
    : node_(std::move(node)), spinner_(kThreads, &queue_) {
  spinner_.start();
}

ServiceHandlers::~ServiceHandlers() {
  for (ros::ServiceServer& server : servers_) {
    server.shutdown();
  }
  queue_.disable();
  spinner_.stop();
}

void ServiceHandlers::offerEmpty(const std::string& name, std::function<void()> action) {
  auto options = ros::AdvertiseServiceOptions::create<std_srvs::Empty>(
      name,
      [action, name](std_srvs::Empty::Request& /*request*/,
                     std_srvs::Empty::Response& /*response*/) {
        try {
          action();
          return true;
        } catch (const std::exception& error) {
          ROS_ERROR_NAMED("franka_sim_mujoco", "%s: %s", name.c_str(), error.what());
          return false;
        }
      },
      ros::VoidConstPtr(), &queue_);
  servers_.push_back(node_.advertiseService(options));
}

}  // namespace franka_sim_mujoco
