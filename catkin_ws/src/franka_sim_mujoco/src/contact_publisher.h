// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <atomic>
#include <thread>

namespace franka_sim_mujoco {

class Simulation;

/// Publishes the contacts of the last tick on `contacts`, 30 times a wall second, while there are
/// subscribers. Has its own thread: the stepping thread only copies the contacts.
class ContactPublisher {
 public:
  /// @param node in whose namespace `contacts` is advertised
  ContactPublisher(ros::NodeHandle node, Simulation& simulation);
  ~ContactPublisher();
  ContactPublisher(const ContactPublisher&) = delete;
  ContactPublisher& operator=(const ContactPublisher&) = delete;

 private:
  void loop();
  void publish();

  Simulation& simulation_;
  ros::Publisher publisher_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace franka_sim_mujoco
