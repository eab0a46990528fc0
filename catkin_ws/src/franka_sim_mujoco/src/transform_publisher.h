// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <realtime_tools/own_callbacks.h>
#include <robot_state_publisher/robot_state_publisher.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>
#include <urdf/model.h>

#include <condition_variable>
#include <mutex>
#include <string>

namespace franka_sim_mujoco {

/// Publishes the transforms of a robot's links for each message on its topic `joint_states`, and
/// constant ones once (/tf, /tf_static), by the library of robot_state_publisher.
///
/// Debian's node of that name requests a parameter from the master twice per message: a few robots
/// at several times real time overload the master. It would also be another process per robot. Here
/// the parameter `tf_prefix`, of the robot's namespace or one above it, is read once. Has its own
/// thread.
class TransformPublisher {
 public:
  /// @param node its namespace contains the joint states
  /// @throws std::runtime_error with a sentence if the URDF's links form no tree
  TransformPublisher(const ros::NodeHandle& node, const urdf::Model& urdf);
  ~TransformPublisher();
  /// Waits until the transforms of this time, or of a later one, have been sent, or a second has
  /// passed. Not real-time safe.
  void waitFor(const ros::Time& time);
  TransformPublisher(const TransformPublisher&) = delete;
  TransformPublisher& operator=(const TransformPublisher&) = delete;

 private:
  void publish(const sensor_msgs::JointState& state);

  const urdf::Model urdf_;
  std::string tf_prefix_;
  robot_state_publisher::RobotStatePublisher publisher_;
  std::mutex mutex_;
  std::condition_variable was_sent_;
  ros::Time sent_;  ///< time of the last transforms; guarded by mutex_
  realtime_tools::OwnCallbacks callbacks_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
};

}  // namespace franka_sim_mujoco
