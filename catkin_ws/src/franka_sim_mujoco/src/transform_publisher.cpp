// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "transform_publisher.h"

#include <algorithm>
#include <chrono>
#include <kdl_parser/kdl_parser.hpp>
#include <map>
#include <stdexcept>

namespace franka_sim_mujoco {

namespace {

constexpr std::uint32_t kQueueSize = 1000;   // as of the topic (JointStatePublisher)
constexpr std::chrono::seconds kMaxWait{1};  // chosen here: a thread that does not run at all

KDL::Tree treeOf(const urdf::Model& urdf) {
  KDL::Tree tree;
  if (!kdl_parser::treeFromUrdfModel(urdf, tree)) {
    throw std::runtime_error("The links of the robot description '" + urdf.getName() +
                             "' do not form a tree: their transforms cannot be published.");
  }
  return tree;
}

std::string readPrefix(const ros::NodeHandle& node) {
  std::string key;
  std::string prefix;
  if (node.searchParam("tf_prefix", key)) {
    node.getParam(key, prefix);
  }
  return prefix;
}

/// Adds positions of mimic joints.
void addMimics(const urdf::Model& urdf, std::map<std::string, double>& positions) {
  for (const auto& [name, joint] : urdf.joints_) {
    if (joint->mimic) {
      const auto leader = positions.find(joint->mimic->joint_name);
      if (leader != positions.end()) {
        positions.emplace(name, joint->mimic->multiplier * leader->second + joint->mimic->offset);
      }
    }
  }
}

}  // namespace

TransformPublisher::TransformPublisher(const ros::NodeHandle& node, const urdf::Model& urdf)
    : urdf_(urdf),
      tf_prefix_(readPrefix(node)),
      publisher_(treeOf(urdf), urdf),
      node_(callbacks_.of(node)) {
  constexpr bool kStatic = true;
  publisher_.publishFixedTransforms(tf_prefix_, kStatic);
  const boost::function<void(const sensor_msgs::JointState&)> callback =
      [this](const sensor_msgs::JointState& state) { publish(state); };
  subscriber_ = node_.subscribe<sensor_msgs::JointState, const sensor_msgs::JointState&>(
      "joint_states", kQueueSize, callback);
  callbacks_.start();
}

TransformPublisher::~TransformPublisher() { callbacks_.stop(); }

void TransformPublisher::publish(const sensor_msgs::JointState& state) {
  std::map<std::string, double> positions;
  for (std::size_t i = 0; i < std::min(state.name.size(), state.position.size()); ++i) {
    positions.emplace(state.name[i], state.position[i]);
  }
  addMimics(urdf_, positions);
  publisher_.publishTransforms(positions, state.header.stamp, tf_prefix_);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    sent_ = state.header.stamp;
  }
  was_sent_.notify_all();
}

void TransformPublisher::waitFor(const ros::Time& time) {
  std::unique_lock<std::mutex> lock(mutex_);
  was_sent_.wait_for(lock, kMaxWait, [&] { return sent_ >= time; });
}

}  // namespace franka_sim_mujoco
