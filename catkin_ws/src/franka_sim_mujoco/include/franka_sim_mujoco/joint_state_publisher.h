// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/trigger_rate.h>
#include <hardware_interface/joint_state_interface.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <urdf/model.h>

#include <optional>
#include <string>
#include <vector>

namespace franka_sim {
class World;
}

namespace franka_sim_mujoco {

class RobotHWSim;

/// Publishes `joint_states`: all moving joints of a robot, arm, hand and what else its URDF has, in
/// one message, whether controllers run or not. It does so in place of Debian's
/// joint_state_publisher, which would be one more Python process a robot. The stepping thread owns
/// it.
class JointStatePublisher {
 public:
  /// @param node in whose namespace the topic lives
  /// @param rate [Hz] of simulated time, above 0 and at most 1000
  /// @param hardware what it measures is published; of joints without a handle there the world's
  /// state is. Outlives this, as the world does.
  JointStatePublisher(const ros::NodeHandle& node, double rate, const urdf::Model& urdf,
                      RobotHWSim& hardware, const franka_sim::World& world);

  /// After the hardware was read, with that tick's time. Skips a message when the last one is still
  /// under way. Real-time safe.
  void tick(const ros::Time& time);

 private:
  struct Joint {
    std::string name;
    std::optional<hardware_interface::JointStateHandle> measured;
  };

  void fill(sensor_msgs::JointState& message, const ros::Time& time) const;

  const franka_sim::World& world_;
  std::vector<Joint> joints_;
  std::optional<franka_hw::TriggerRate> due_;  ///< from the first tick on
  double rate_;
  realtime_tools::RealtimePublisher<sensor_msgs::JointState> publisher_;
};

/// The URDF's joints with one degree of freedom, from the root outwards.
std::vector<std::string> movingJoints(const urdf::Model& urdf);

}  // namespace franka_sim_mujoco
