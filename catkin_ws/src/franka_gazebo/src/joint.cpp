// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_gazebo/joint.h>

#include <cmath>

namespace franka_gazebo {

namespace {

double rate(double now, const boost::optional<double>& before, const ros::Duration& period) {
  return before && period.toSec() > 0.0 ? (now - *before) / period.toSec() : 0.0;
}

}  // namespace

// The mutex is not moved; no other thread may use a joint that is moved from.
Joint::Joint(Joint&& other) noexcept
    : name(std::move(other.name)),
      handle(other.handle),
      type(other.type),
      limits(other.limits),
      axis(other.axis),
      command(other.command),
      desired_position(other.desired_position),
      desired_velocity(other.desired_velocity),
      gravity(other.gravity),
      position(other.position),
      velocity(other.velocity),
      effort(other.effort),
      jerk(other.jerk),
      acceleration(other.acceleration),
      stop_position(other.stop_position),
      contact_threshold(other.contact_threshold),
      collision_threshold(other.collision_threshold),
      control_method(other.control_method),
      position_controller(other.position_controller),
      velocity_controller(other.velocity_controller),
      last_velocity_(other.last_velocity_),
      last_acceleration_(other.last_acceleration_),
      requested_position_(other.requested_position_) {}

void Joint::update(const ros::Duration& period) {
  if (handle == nullptr) {
    return;
  }
  const franka_sim::JointMeasurement measured = handle->measure();
  position = measured.position;
  velocity = measured.velocity;
  effort = measured.effort;
  {
    const std::lock_guard<std::mutex> lock(requested_mutex_);
    if (requested_position_) {
      position = desired_position = stop_position = *requested_position_;
      requested_position_.reset();
    }
  }
  acceleration = rate(velocity, last_velocity_, period);
  jerk = rate(acceleration, last_acceleration_, period);
  last_velocity_ = velocity;
  last_acceleration_ = acceleration;
}

bool Joint::controlledBy(const franka::RobotMode& mode, ControlMethod method) const {
  return mode == franka::RobotMode::kMove && control_method && *control_method == method;
}

double Joint::getDesiredPosition(const franka::RobotMode& mode) const {
  return mode != franka::RobotMode::kMove || controlledBy(mode, EFFORT) ? position
                                                                        : desired_position;
}

double Joint::getDesiredVelocity(const franka::RobotMode& mode) const {
  return controlledBy(mode, VELOCITY) ? desired_velocity : velocity;
}

double Joint::getDesiredAcceleration(const franka::RobotMode& mode) const {
  return controlledBy(mode, EFFORT) ? 0.0 : acceleration;
}

double Joint::getDesiredTorque(const franka::RobotMode& mode) const {
  return controlledBy(mode, EFFORT) ? command : 0.0;
}

double Joint::getLinkMass() const { return std::numeric_limits<double>::quiet_NaN(); }

bool Joint::isInContact() const { return std::abs(effort - command) > contact_threshold; }

bool Joint::isInCollision() const { return std::abs(effort - command) > collision_threshold; }

void Joint::setJointPosition(double joint_position) {
  const std::lock_guard<std::mutex> lock(requested_mutex_);
  requested_position_ = joint_position;
}

}  // namespace franka_gazebo
