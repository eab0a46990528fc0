// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/trigger_rate.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <hardware_interface/joint_state_interface.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <urdf/model.h>

#include <optional>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// Publishes `joint_states`: all moving joints of a robot, arm, hand and other joints of its URDF,
/// in one message, with or without controllers. Replaces Debian's joint_state_publisher, which
/// would be another Python process per robot. Owned by the stepping thread.
class JointStatePublisher {
 public:
  /// @param node its namespace contains the topic
  /// @param rate [Hz] of simulated time, above 0 and at most 1000
  /// @param hardware its measurements are published; for joints without a handle there the world's
  /// state is used. Must outlive this object, like the world.
  /// @param between_ticks of a RobotHandle
  JointStatePublisher(const ros::NodeHandle& node, double rate, const urdf::Model& urdf,
                      RobotHWSim& hardware, const franka_sim::World& world,
                      const BetweenTicks& between_ticks);

  /// Call after the hardware was read, with that tick's time. A message that is due is skipped only
  /// if the last one was not sent meanwhile (realtime_tools::publishPending). Real-time safe.
  /// @returns whether a message was published
  bool tick(const ros::Time& time);
  /// Publishes the present state of the world, whether or not a message is due; tick() does not
  /// repeat this time. Not real-time safe.
  void publishNow(const ros::Time& time);

 private:
  struct Joint {
    std::string name;
    std::optional<hardware_interface::JointStateHandle> measured;
  };

  void fill(sensor_msgs::JointState& message, const ros::Time& time) const;
  franka_sim::JointMeasurement measure(const Joint& joint) const;

  const franka_sim::World& world_;
  std::vector<Joint> joints_;
  std::optional<franka_hw::TriggerRate> due_;  ///< set in the first tick
  double rate_;
  ros::Time published_;  ///< the last time of publishNow()
  realtime_tools::RealtimePublisher<sensor_msgs::JointState> publisher_;
};

/// The URDF's joints with one degree of freedom, from the root to the leaves.
std::vector<std::string> movingJoints(const urdf::Model& urdf);

}  // namespace franka_sim_mujoco
