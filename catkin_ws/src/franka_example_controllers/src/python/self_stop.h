// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <string>

namespace franka_example_controllers {

/// Lets a failed controller stop itself through its controller manager's service, from a thread
/// beside the loop, so that it works with every controller manager and stops no other controller.
/// Starts the controllers named in `fallback_controllers` in its place.
class SelfStop {
 public:
  /// @param report called in the thread when the controller has failed: logs the cause
  /// @param root_nh of the controller manager, @param controller_nh of the controller
  SelfStop(ros::NodeHandle& root_nh, ros::NodeHandle& controller_nh, std::function<void()> report);
  ~SelfStop();
  SelfStop(const SelfStop&) = delete;
  SelfStop& operator=(const SelfStop&) = delete;

  /// From the loop: the controller has failed; reports it.
  void fail();
  /// From the loop: the robot is at rest; stops the controller.
  void stop();
  /// Name of the controller, as its manager knows it.
  const std::string& name() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
};

}  // namespace franka_example_controllers
