// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "gazebo_models.h"

#include <franka_sim/physics/pose_conversions.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim_messages.h"
#include "simulation.h"

namespace franka_sim_mujoco {

namespace {

using franka_sim::array;
using franka_sim::toIsometry;
using franka_sim::toPose;
using franka_sim::vector;

constexpr char kScope[] = "::";

template <typename Message>
franka_sim::BodyState toState(const Message& message) {
  const franka_sim::Twist twist = fromMessage(message.twist);
  checkFinite({twist.linear[0], twist.linear[1], twist.linear[2], twist.angular[0],
               twist.angular[1], twist.angular[2]},
              "twist");
  return {fromGazebo(message.pose), twist};
}

}  // namespace

const franka_sim::WorldModel& GazeboModels::model(const std::string& name) const {
  const auto found =
      std::find_if(models_.begin(), models_.end(),
                   [&](const franka_sim::WorldModel& model) { return model.name == name; });
  if (found == models_.end()) {
    throw std::runtime_error("There is no model '" + name + "' in the simulated world.");
  }
  return *found;
}

const franka_sim::WorldJoint& GazeboModels::joint(const std::string& name) const {
  for (const franka_sim::WorldModel& model : models_) {
    for (const franka_sim::WorldJoint& joint : model.joints) {
      if (joint.name == name || linkName(model, joint.name) == name) {
        return joint;
      }
    }
  }
  throw std::runtime_error("There is no joint '" + name + "' that moves in the simulated world.");
}

bool GazeboModels::isWorld(const std::string& frame) {
  return frame.empty() || frame == "world" || frame == "map" || frame == "/map";
}

std::string GazeboModels::linkName(const franka_sim::WorldModel& model, const std::string& link) {
  const std::string scope = model.name + kScope;
  return link.compare(0, scope.size(), scope) == 0 ? link : scope + link;
}

std::string GazeboModels::body(const std::string& name) const {
  for (const franka_sim::WorldModel& model : models_) {
    if (model.name == name) {
      return model.body;
    }
    for (const std::string& link : model.links) {
      if (link == name || linkName(model, link) == name) {
        return link;
      }
    }
  }
  throw std::runtime_error("There is no model or link '" + name + "' in the simulated world.");
}

franka_sim::BodyState GazeboModels::toFrame(const franka_sim::BodyState& in_world,
                                            const std::string& frame) const {
  if (isWorld(frame)) {
    return in_world;
  }
  const franka_sim::BodyState base = bodyState(world_, body(frame));
  const Eigen::Isometry3d pose = toIsometry(base.pose);
  const Eigen::Matrix3d turn = pose.linear().transpose();
  const franka_sim::Twist& twist = in_world.twist;
  return {
      toPose(pose.inverse() * toIsometry(in_world.pose)),
      {array(turn * (vector(twist.linear) - vector(base.twist.linear))),
       array(turn * (vector(twist.angular) - vector(base.twist.angular)))},
  };
}

franka_sim::BodyState GazeboModels::toWorld(const franka_sim::BodyState& in_frame,
                                            const std::string& frame) const {
  if (isWorld(frame)) {
    return in_frame;
  }
  const Eigen::Isometry3d pose = toIsometry(bodyPose(world_, body(frame)));
  return {
      toPose(pose * toIsometry(in_frame.pose)),
      {array(pose.linear() * vector(in_frame.twist.linear)),
       array(pose.linear() * vector(in_frame.twist.angular))},
  };
}

void GazeboModels::place(const std::string& name, const franka_sim::BodyState& state,
                         const std::string& frame) {
  setBodyState(world_, body(name), toWorld(state, frame));
}

void place(Simulation& simulation, const gazebo_msgs::ModelState& state) {
  const franka_sim::BodyState target = toState(state);
  simulation.withWorld([&](franka_sim::World& world) {
    GazeboModels models(world);
    models.model(state.model_name);  // throws for the name of a link
    models.place(state.model_name, target, state.reference_frame);
  });
}

void place(Simulation& simulation, const gazebo_msgs::LinkState& state) {
  const franka_sim::BodyState target = toState(state);
  simulation.withWorld([&](franka_sim::World& world) {
    GazeboModels(world).place(state.link_name, target, state.reference_frame);
  });
}

franka_sim::Pose fromGazebo(geometry_msgs::Pose message) {
  geometry_msgs::Quaternion& q = message.orientation;
  const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (length == 0.0) {
    q.w = 1.0;
  } else if (std::isfinite(length)) {
    q.x /= length;
    q.y /= length;
    q.z /= length;
    q.w /= length;
  }
  return fromMessage(message);
}

}  // namespace franka_sim_mujoco
