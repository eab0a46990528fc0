// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/input_limits.h>
#include <franka_sim/physics/world_bodies.h>

#include <algorithm>
#include <stdexcept>

#include "physics/world/world_impl.h"

namespace franka_sim {

Pose bodyPose(const World& world, const std::string& body) {
  World::Impl& impl = implOf(world);
  return toPose(impl.pose(impl.frame(body)));
}

std::vector<Pose> framePoses(const World& world) {
  World::Impl& impl = implOf(world);
  std::vector<Pose> poses;
  poses.reserve(impl.ordered_frames.size());
  for (const NamedFrame& named : impl.ordered_frames) {
    poses.push_back(toPose(impl.pose(named.frame)));
  }
  return poses;
}

void checkBodyPose(const World& world, const std::string& body, const Pose& pose) {
  implOf(world).freeJoint(body);
  sizes::check(pose.position, sizes::kMaxPosition, "m", "The position for body '" + body + "'");
  if (!hasUnitOrientation(pose)) {
    throw std::runtime_error("The orientation for body '" + body + "' is not a unit quaternion.");
  }
}

void setBodyPose(World& world, const std::string& body, const Pose& pose) {
  World::Impl& impl = implOf(world);
  checkBodyPose(world, body, pose);
  impl.requireRuns();
  const int joint = impl.freeJoint(body);
  const Frame frame = impl.frame(body);
  const bool is_body = frame.pose.matrix().isIdentity(0);
  const Eigen::Isometry3d place =
      is_body ? toIsometry(pose) : toIsometry(pose) * frame.pose.inverse();
  double* qpos = impl.data->qpos + impl.model->jnt_qposadr[joint];
  Eigen::Vector3d::Map(qpos) = place.translation();
  const Eigen::Quaterniond unit =
      is_body ? quaternion(pose).normalized() : Eigen::Quaterniond(place.linear()).normalized();
  qpos[3] = unit.w();
  qpos[4] = unit.x();
  qpos[5] = unit.y();
  qpos[6] = unit.z();
  mju_zero(impl.data->qvel + impl.model->jnt_dofadr[joint], 6);
  impl.disturb();
}

std::vector<BodyState> bodyStates(const World& world, const std::vector<std::string>& names) {
  World::Impl& impl = implOf(world);
  std::vector<BodyState> states;
  for (const std::string& name : names) {
    states.push_back({bodyPose(world, name), Twist{}});
  }
  // Velocities at the present positions; mj_comVel writes what the next step computes anyway.
  mj_comPos(impl.model.get(), impl.data.get());
  mj_comVel(impl.model.get(), impl.data.get());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const int body = impl.frame(names[i]).body;
    double velocity[6];  // angular, linear at the body's origin
    mj_objectVelocity(impl.model.get(), impl.data.get(), mjOBJ_XBODY, body, velocity, 0);
    const Eigen::Vector3d angular(velocity[0], velocity[1], velocity[2]);
    const Eigen::Vector3d linear(velocity[3], velocity[4], velocity[5]);
    const Eigen::Map<const Eigen::Vector3d> at(impl.data->xpos + 3 * body);
    const Eigen::Map<const Eigen::Vector3d> origin(states[i].pose.position.data());
    states[i].twist = {array(linear + angular.cross(origin - at)), array(angular)};
  }
  return states;
}

BodyState bodyState(const World& world, const std::string& body) {
  return bodyStates(world, {body}).front();
}

namespace {

void checkTwist(const std::string& body, const Twist& twist) {
  sizes::check(twist.linear, sizes::kMaxVelocity, "m/s",
               "The linear velocity of body '" + body + "'");
  sizes::check(twist.angular, sizes::kMaxVelocity, "rad/s",
               "The angular velocity of body '" + body + "'");
}

}  // namespace

void setBodyState(World& world, const std::string& body, const BodyState& state) {
  checkTwist(body, state.twist);
  setBodyPose(world, body, state.pose);
  setBodyTwist(world, body, state.twist);
}

void setBodyTwist(World& world, const std::string& body, const Twist& twist) {
  World::Impl& impl = implOf(world);
  const int joint = impl.freeJoint(body);
  impl.requireRuns();
  checkTwist(body, twist);
  const Frame frame = impl.frame(body);
  const Eigen::Isometry3d pose = impl.pose(frame);
  const Eigen::Isometry3d body_pose = pose * frame.pose.inverse();
  double* qvel = impl.data->qvel + impl.model->jnt_dofadr[joint];
  // MuJoCo: linear velocity in world axes, angular velocity in body axes.
  const Eigen::Vector3d lever = body_pose.translation() - pose.translation();
  Eigen::Vector3d::Map(qvel) = vector(twist.linear) + vector(twist.angular).cross(lever);
  Eigen::Vector3d::Map(qvel + 3) = body_pose.linear().transpose() * vector(twist.angular);
  impl.disturb();
}

BodyInertia bodyInertia(const World& world, const std::string& body) {
  const Frame frame = implOf(world).frame(body);
  const mjModel& model = *implOf(world).model;
  if (!frame.pose.isApprox(Eigen::Isometry3d::Identity(), 1e-12)) {
    throw std::runtime_error("Body '" + body + "' is fixed to '" +
                             mj_id2name(&model, mjOBJ_BODY, frame.body) +
                             "', whose inertia contains its own.");
  }
  const double* q = model.body_iquat + 4 * frame.body;
  const Eigen::Matrix3d axes = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  const Eigen::Map<const Eigen::Vector3d> principal(model.body_inertia + 3 * frame.body);
  const Eigen::Matrix3d inertia = axes * principal.asDiagonal() * axes.transpose();
  const double* center = model.body_ipos + 3 * frame.body;
  return {
      model.body_mass[frame.body],
      {center[0], center[1], center[2]},
      {inertia(0, 0), inertia(0, 1), inertia(0, 2), inertia(1, 1), inertia(1, 2), inertia(2, 2)},
      !physics::LinksWithoutGravity::has(model, frame.body)};
}

}  // namespace franka_sim
