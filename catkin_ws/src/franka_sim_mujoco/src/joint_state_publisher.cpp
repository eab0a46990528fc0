// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "joint_state_publisher.h"

#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim_mujoco/robot_hw_sim.h>

#include <algorithm>

namespace franka_sim_mujoco {

namespace {

/// Messages that wait for a subscriber while the simulation runs faster than it reads (chosen
/// here).
constexpr int kQueueSize = 1000;

void appendMovingJoints(const urdf::Link& link, std::vector<std::string>& names) {
  for (const urdf::JointSharedPtr& joint : link.child_joints) {
    if (joint->type == urdf::Joint::REVOLUTE || joint->type == urdf::Joint::CONTINUOUS ||
        joint->type == urdf::Joint::PRISMATIC) {
      names.push_back(joint->name);
    }
  }
  for (const urdf::LinkSharedPtr& child : link.child_links) {
    appendMovingJoints(*child, names);
  }
}

}  // namespace

std::vector<std::string> movingJoints(const urdf::Model& urdf) {
  std::vector<std::string> names;
  if (urdf.getRoot()) {
    appendMovingJoints(*urdf.getRoot(), names);
  }
  return names;
}

JointStatePublisher::JointStatePublisher(const ros::NodeHandle& node, double rate,
                                         const urdf::Model& urdf, RobotHWSim& hardware,
                                         const franka_sim::World& world,
                                         const BetweenTicks& between_ticks)
    : world_(world), rate_(rate), publisher_(node, "joint_states", kQueueSize) {
  auto* const handles = hardware.get<hardware_interface::JointStateInterface>();
  const std::vector<std::string> measured =
      handles != nullptr ? handles->getNames() : std::vector<std::string>();
  std::vector<std::string> in_world;
  between_ticks([&] { in_world = world.joints(); });
  const auto contains = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const std::string& name : movingJoints(urdf)) {
    if (contains(measured, name)) {
      joints_.push_back({name, handles->getHandle(name)});
    } else if (contains(in_world, name)) {
      joints_.push_back({name, std::nullopt});
    }
  }
  publisher_.lock();
  sensor_msgs::JointState& message = publisher_.msg_;
  for (const Joint& joint : joints_) {
    message.name.push_back(joint.name);
  }
  message.position.resize(joints_.size());
  message.velocity.resize(joints_.size());
  message.effort.resize(joints_.size());
  publisher_.unlock();
}

bool JointStatePublisher::tick(const ros::Time& time) {
  if (!due_) {
    due_.emplace(rate_, time);
  } else if (!(*due_)(time)) {
    return false;
  }
  if (time == published_ || !publisher_.trylock()) {
    return false;
  }
  fill(publisher_.msg_, time);
  publisher_.unlockAndPublish();
  return true;
}

void JointStatePublisher::publishNow(const ros::Time& time) {
  publisher_.lock();
  // The handles still have the measurements of the last tick's begin.
  sensor_msgs::JointState& message = publisher_.msg_;
  fill(message, time);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const franka_sim::JointMeasurement joint = jointState(world_, joints_[i].name);
    message.position[i] = joint.position;
    message.velocity[i] = joint.velocity;
  }
  publisher_.unlockAndPublish();
  published_ = time;
}

void JointStatePublisher::fill(sensor_msgs::JointState& message, const ros::Time& time) const {
  message.header.stamp = time;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const franka_sim::JointMeasurement joint = measure(joints_[i]);
    message.position[i] = joint.position;
    message.velocity[i] = joint.velocity;
    message.effort[i] = joint.effort;
  }
}

franka_sim::JointMeasurement JointStatePublisher::measure(const Joint& joint) const {
  if (!joint.measured) {
    return jointState(world_, joint.name);
  }
  return {joint.measured->getPosition(), joint.measured->getVelocity(),
          joint.measured->getEffort()};
}

}  // namespace franka_sim_mujoco
