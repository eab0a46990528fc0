// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/advertise_service_options.h>
#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_srvs/Empty.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <exception>
#include <functional>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// Text of the exception that is being handled: call it in `catch (...)`. Exceptions of XmlRpc, as
/// other people's hardware throws for a parameter of the wrong type, do not derive from
/// std::exception.
inline std::string exceptionText() {
  try {
    throw;
  } catch (const std::exception& error) {
    return error.what();
  } catch (const XmlRpc::XmlRpcException& error) {
    return "a parameter has the wrong type: " + error.getMessage();
  } catch (...) {
    return "an exception of unknown type";
  }
}

// Names of loggers, for the macros ROS_*_NAMED.
constexpr char kLog[] = "franka_sim_mujoco";      ///< of the simulation
constexpr char kHardwareLog[] = "franka_hw_sim";  ///< of FrankaHWSim and its services

/// Sets a service's error message; some types have another field for it.
template <typename Response>
auto explain(Response& response, const std::string& text) -> decltype((void)response.error) {
  response.error = text;
}
template <typename Response>
auto explain(Response& response, const std::string& text)
    -> decltype((void)response.status_message) {
  response.status_message = text;
}
inline void explain(std_srvs::SetBool::Response& response, const std::string& text) {
  response.message = text;
}
inline void explain(std_srvs::Trigger::Response& response, const std::string& text) {
  response.message = text;
}

/// Runs a handler and sets the response: true, or only false and a sentence.
/// @param handler may throw an exception with a sentence for the user
/// @param report also receives that sentence, for the log
template <typename Response>
void answer(Response& response, const std::function<void()>& handler,
            const std::function<void(const char*)>& report) {
  try {
    handler();
    response.success = true;
  } catch (...) {
    const std::string sentence = exceptionText();
    report(sentence.c_str());
    response = Response();
    response.success = false;
    explain(response, sentence);
  }
}

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
