// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "shutdown_request.h"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/xmlrpc_manager.h>

#include <atomic>
#include <csignal>
#include <string>

#include "service_handlers.h"

namespace franka_sim_mujoco {

namespace {

constexpr std::chrono::milliseconds kPeriod{20};  // of looking for a request

std::atomic<bool> requested{false};  // lock-free, as a signal handler needs

void takeSignal(int /*signal*/) { requested = true; }

/// The method `shutdown` of the ROS slave API.
void answerKill(XmlRpc::XmlRpcValue& parameters, XmlRpc::XmlRpcValue& result) {
  using XmlRpc::XmlRpcValue;
  if (parameters.getType() == XmlRpcValue::TypeArray && parameters.size() > 1 &&
      parameters[1].getType() == XmlRpcValue::TypeString) {
    ROS_WARN_NAMED(kLog, "The node is asked to end: %s",
                   static_cast<std::string&>(parameters[1]).c_str());
  }
  result = ros::xmlrpc::responseInt(1, "", 0);
  requestShutdown();
}

}  // namespace

void requestShutdown() { requested = true; }

ShutdownRequest::ShutdownRequest(std::chrono::milliseconds patience) : patience_(patience) {
  requested = false;
  ros::start();  // sets roscpp's own handlers, once
  std::signal(SIGINT, takeSignal);
  ros::XMLRPCManager::instance()->unbind("shutdown");
  ros::XMLRPCManager::instance()->bind("shutdown", answerKill);
}

ShutdownRequest::~ShutdownRequest() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  if (limit_.joinable()) {
    limit_.join();
  }
}

void ShutdownRequest::wait() {
  while (!requested && ros::ok()) {
    std::this_thread::sleep_for(kPeriod);
  }
  if (!ros::ok()) {
    return;
  }
  limit_ = std::thread([this] {
    std::unique_lock<std::mutex> lock(mutex_);
    if (!changed_.wait_for(lock, patience_, [this] { return ended_; })) {
      lock.unlock();
      ros::shutdown();
    }
  });
}

}  // namespace franka_sim_mujoco
