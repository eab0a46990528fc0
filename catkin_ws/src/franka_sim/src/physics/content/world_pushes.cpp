// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/world_pushes.h>

#include <algorithm>
#include <stdexcept>

#include "physics/world/world_impl.h"

namespace franka_sim {

namespace {

/// @param what for example "body 'stone'"
void checkPush(std::size_t others, const std::string& what, std::uint64_t ticks) {
  if (ticks > sizes::kMaxPushTicks && ticks != sizes::kEndlessPush) {
    throw std::runtime_error("The push on " + what + " lasts " + std::to_string(ticks) +
                             " ms; give at most " + std::to_string(sizes::kMaxPushTicks) + ".");
  }
  if (others >= sizes::kMaxPushes) {
    throw std::runtime_error("The push on " + what +
                             " is refused: " + std::to_string(sizes::kMaxPushes) +
                             " pushes act already. Wait until they end.");
  }
}

}  // namespace

void pushBody(World& world, const std::string& body, const std::array<double, 3>& force,
              const std::array<double, 3>& torque, std::uint64_t ticks,
              const std::optional<std::array<double, 3>>& point) {
  World::Impl& impl = implOf(world);
  const Frame frame = impl.frame(body);
  impl.requireRuns();
  if (point) {
    sizes::check(*point, sizes::kMaxPosition, "m", "The point of the push");
  }
  sizes::check(force, sizes::kMaxForce, "N", "The force on body '" + body + "'");
  sizes::check(torque, sizes::kMaxForce, "Nm", "The torque on body '" + body + "'");
  checkPush(impl.pushes.size(), "body '" + body + "'", ticks);
  if (ticks == 0) {
    return;
  }
  const Frame origin{frame.body, Eigen::Isometry3d::Identity()};
  const Eigen::Vector3d at =
      point ? impl.pose(origin).inverse() * vector(*point) : frame.pose.translation();
  impl.addPush({body, frame.body, at, vector(force), vector(torque), ticks});
}

void endPushes(World& world, const std::string& body) {
  World::Impl& impl = implOf(world);
  impl.frame(body);  // throws for an unknown one
  const auto ends = [&](const Push& push) { return push.joint.empty() && push.body_name == body; };
  impl.pushes.erase(std::remove_if(impl.pushes.begin(), impl.pushes.end(), ends),
                    impl.pushes.end());
  impl.disturb();
}

void pushJoint(World& world, const std::string& joint, double effort, std::uint64_t ticks) {
  World::Impl& impl = implOf(world);
  const int dof = impl.slot(joint).dof;
  const int body = impl.model->dof_bodyid[dof];
  if (!impl.isObject(body)) {
    throw std::runtime_error("Joint '" + joint +
                             "' belongs to a robot, whose controller commands its efforts. Push "
                             "its link instead (a Gazebo client: apply_body_wrench).");
  }
  impl.requireRuns();
  sizes::check(effort, sizes::kMaxForce, "N or Nm", "The effort on joint '" + joint + "'");
  checkPush(impl.pushes.size(), "joint '" + joint + "'", ticks);
  if (ticks > 0) {
    impl.addPush({"", body, {}, {}, {}, ticks, joint, effort, dof});
  }
}

void endJointPushes(World& world, const std::string& joint) {
  World::Impl& impl = implOf(world);
  impl.slot(joint);  // throws for an unknown one
  impl.pushes.erase(std::remove_if(impl.pushes.begin(), impl.pushes.end(),
                                   [&](const Push& push) { return push.joint == joint; }),
                    impl.pushes.end());
  impl.disturb();
}

}  // namespace franka_sim
