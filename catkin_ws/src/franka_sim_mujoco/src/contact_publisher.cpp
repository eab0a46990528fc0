// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "contact_publisher.h"

#include <franka_sim_mujoco/Contacts.h>
#include <ros/console.h>

#include <chrono>
#include <exception>

#include "sim_messages.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

constexpr std::chrono::milliseconds kContactInterval{33};

}  // namespace

ContactPublisher::ContactPublisher(ros::NodeHandle node, Simulation& simulation)
    : simulation_(simulation), publisher_(node.advertise<Contacts>("contacts", 1)) {
  thread_ = std::thread([this] { loop(); });
}

ContactPublisher::~ContactPublisher() {
  stop_ = true;
  thread_.join();
}

void ContactPublisher::loop() {
  while (!stop_) {
    std::this_thread::sleep_for(kContactInterval);
    if (publisher_.getNumSubscribers() == 0) {
      continue;
    }
    try {
      publish();
    } catch (const std::exception& error) {
      ROS_WARN_THROTTLE_NAMED(10.0, "franka_sim_mujoco", "No contacts are published: %s",
                              error.what());
    }
  }
}

void ContactPublisher::publish() {
  std::vector<franka_sim::Contact> contacts;
  simulation_.withWorld([&](franka_sim::World& world) { contacts = franka_sim::contacts(world); });
  Contacts message;
  message.header.stamp = simulation_.state().time;
  message.header.frame_id = "world";
  for (const franka_sim::Contact& contact : contacts) {
    append(contact, message);
  }
  publisher_.publish(message);
}

}  // namespace franka_sim_mujoco
