// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_contacts.h>
#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Vector3.h>

#include <initializer_list>
#include <vector>

namespace franka_sim_mujoco {

/// @throws std::runtime_error "The <what> must be made of finite numbers."
void checkFinite(std::initializer_list<double> numbers, const char* what);

/// @throws std::runtime_error for numbers that are not finite and quaternions that are not of
/// length 1
franka_sim::Pose fromMessage(const geometry_msgs::Pose& message);
geometry_msgs::Pose toMessage(const franka_sim::Pose& pose);
franka_sim::Twist fromMessage(const geometry_msgs::Twist& message);
geometry_msgs::Twist toMessage(const franka_sim::Twist& twist);
std::array<double, 3> fromMessage(const geometry_msgs::Vector3& message);
geometry_msgs::Vector3 toVector(const std::array<double, 3>& vector);
geometry_msgs::Point toPoint(const std::array<double, 3>& point);

/// Appends a contact to the four arrays of a GetContacts response or a Contacts message.
template <typename Message>
void append(const franka_sim::Contact& contact, Message& message) {
  message.body1s.push_back(contact.body1);
  message.body2s.push_back(contact.body2);
  message.positions.push_back(toPoint(contact.position));
  message.forces.push_back(toVector(contact.force));
}

}  // namespace franka_sim_mujoco
