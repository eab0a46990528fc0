// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "sim_messages.h"

#include <franka_core/numbers.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace franka_sim_mujoco {

void checkFinite(std::initializer_list<double> numbers, const char* what) {
  for (const double number : numbers) {
    if (!std::isfinite(number)) {
      throw std::runtime_error(std::string("The ") + what + " must be made of finite numbers.");
    }
  }
}

franka_sim::Pose fromMessage(const geometry_msgs::Pose& message) {
  franka_sim::Pose pose;
  pose.position = {message.position.x, message.position.y, message.position.z};
  std::array<double, 4>& q = pose.orientation;
  q = {message.orientation.w, message.orientation.x, message.orientation.y, message.orientation.z};
  checkFinite({pose.position[0], pose.position[1], pose.position[2], q[0], q[1], q[2], q[3]},
              "pose");
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (std::abs(norm - 1.0) > 1e-3) {
    throw std::runtime_error("The orientation must be a unit quaternion; its length is " +
                             franka_core::numberText(norm) + ".");
  }
  for (double& entry : q) {
    entry /= norm;
  }
  return pose;
}

geometry_msgs::Pose toMessage(const franka_sim::Pose& pose) {
  geometry_msgs::Pose message;
  message.position = toPoint(pose.position);
  message.orientation.w = pose.orientation[0];
  message.orientation.x = pose.orientation[1];
  message.orientation.y = pose.orientation[2];
  message.orientation.z = pose.orientation[3];
  return message;
}

franka_sim::Twist fromMessage(const geometry_msgs::Twist& message) {
  return {fromMessage(message.linear), fromMessage(message.angular)};
}

geometry_msgs::Twist toMessage(const franka_sim::Twist& twist) {
  geometry_msgs::Twist message;
  message.linear = toVector(twist.linear);
  message.angular = toVector(twist.angular);
  return message;
}

std::array<double, 3> fromMessage(const geometry_msgs::Vector3& message) {
  return {message.x, message.y, message.z};
}

geometry_msgs::Vector3 toVector(const std::array<double, 3>& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector[0];
  message.y = vector[1];
  message.z = vector[2];
  return message;
}

geometry_msgs::Point toPoint(const std::array<double, 3>& point) {
  geometry_msgs::Point message;
  message.x = point[0];
  message.y = point[1];
  message.z = point[2];
  return message;
}

}  // namespace franka_sim_mujoco
