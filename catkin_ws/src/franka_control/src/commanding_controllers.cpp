// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "commanding_controllers.h"

#include <controller_manager_msgs/ListControllers.h>
#include <controller_manager_msgs/SwitchController.h>
#include <ros/console.h>
#include <ros/service.h>

#include <algorithm>

namespace franka_control {

namespace {

constexpr double kTimeout = 2.0;  // [s]

bool commands(const controller_manager_msgs::ControllerState& controller) {
  return controller.state == "running" &&
         std::any_of(controller.claimed_resources.begin(), controller.claimed_resources.end(),
                     [](const auto& claimed) { return !claimed.resources.empty(); });
}

}  // namespace

bool stopCommandingControllers(const ros::NodeHandle& nh) {
  controller_manager_msgs::ListControllers list;
  if (!ros::service::call(nh.resolveName("controller_manager/list_controllers"), list)) {
    ROS_ERROR("franka_control: the controller manager did not report which controllers run.");
    return false;
  }
  controller_manager_msgs::SwitchController stop;
  for (const auto& controller : list.response.controller) {
    if (commands(controller)) {
      stop.request.stop_controllers.push_back(controller.name);
    }
  }
  if (stop.request.stop_controllers.empty()) {
    return true;
  }
  stop.request.strictness = controller_manager_msgs::SwitchControllerRequest::BEST_EFFORT;
  stop.request.timeout = kTimeout;
  if (!ros::service::call(nh.resolveName("controller_manager/switch_controller"), stop) ||
      !stop.response.ok) {
    ROS_ERROR("franka_control: the controllers could not be stopped.");
    return false;
  }
  return true;
}

}  // namespace franka_control
