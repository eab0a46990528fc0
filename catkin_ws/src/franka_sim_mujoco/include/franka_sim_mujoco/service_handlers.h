// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/service_answer.h>
#include <ros/advertise_service_options.h>
#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_srvs/Empty.h>

#include <functional>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// ROS services that answer success=false and a sentence instead of failing the call. They have
/// their own threads: a controller switch that waits for a paused simulation must not block the
/// service that unpauses it.
class ServiceHandlers {
 public:
  /// @param node its namespace contains the services
  explicit ServiceHandlers(ros::NodeHandle node);
  /// Waits until no handler runs any more.
  ~ServiceHandlers();
  ServiceHandlers(const ServiceHandlers&) = delete;
  ServiceHandlers& operator=(const ServiceHandlers&) = delete;

  /// @param handler may throw an exception with a sentence for the user
  template <typename Service>
  void offer(const std::string& name,
             std::function<void(typename Service::Request&, typename Service::Response&)> handler) {
    auto options = ros::AdvertiseServiceOptions::create<Service>(
        name,
        [handler, name](typename Service::Request& request, typename Service::Response& response) {
          answer(
              response, [&] { handler(request, response); },
              [&](const char* sentence) {
                ROS_WARN_NAMED("franka_sim_mujoco", "%s: %s", name.c_str(), sentence);
              });
          return true;
        },
        ros::VoidConstPtr(), &queue_);
    servers_.push_back(node_.advertiseService(options));
  }
  /// A service with an empty response, as in Gazebo: a failure fails the call.
  template <typename Service = std_srvs::Empty>
  void offerEmpty(const std::string& name,
                  std::function<void(const typename Service::Request&)> action) {
    auto options = ros::AdvertiseServiceOptions::create<Service>(
        name,
        [action, name](typename Service::Request& request, typename Service::Response&) {
          try {
            action(request);
            return true;
          } catch (...) {
            ROS_ERROR_NAMED("franka_sim_mujoco", "%s: %s", name.c_str(), exceptionText().c_str());
            return false;
          }
        },
        ros::VoidConstPtr(), &queue_);
    servers_.push_back(node_.advertiseService(options));
  }

 private:
  ros::NodeHandle node_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  ros::AsyncSpinner spinner_;
};

}  // namespace franka_sim_mujoco
