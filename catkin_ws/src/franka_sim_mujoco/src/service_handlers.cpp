// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "service_handlers.h"

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

}  // namespace franka_sim_mujoco
