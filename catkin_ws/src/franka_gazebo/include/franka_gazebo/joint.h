// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <control_toolbox/pid.h>
#include <franka/robot_state.h>
#include <franka_gazebo/controller_verifier.h>
#include <franka_sim/robot/plant.h>
#include <joint_limits_interface/joint_limits.h>
#include <ros/duration.h>

#include <Eigen/Core>
#include <boost/optional.hpp>
#include <limits>
#include <mutex>
#include <string>

namespace franka_gazebo {

/// A joint and its desired motion, for programs written for the original. The simulation itself
/// does not use it. Positions [rad] or [m], efforts [Nm] or [N]. Called by one thread. Exception:
/// setJointPosition.
struct Joint {
  Joint() = default;
  Joint(Joint&& other) noexcept;
  Joint(const Joint&) = delete;
  Joint& operator=(const Joint&) = delete;

  /// Reads the drive; acceleration and jerk are differences, 0 at first and for a period of 0.
  /// Without a drive nothing happens.
  void update(const ros::Duration& period);

  std::string name;                               ///< of the joint in the URDF
  franka_sim::JointDrive* handle{nullptr};        ///< replaces Gazebo's joint
  int type{0};                                    ///< of urdf::Joint
  joint_limits_interface::JointLimits limits;     ///< of the URDF
  Eigen::Vector3d axis{Eigen::Vector3d::Zero()};  ///< of the joint

  double command{0};                                ///< of an effort controller, without gravity
  double desired_position{0}, desired_velocity{0};  ///< of motions
  double gravity{0};                                ///< added to the command
  double position{0}, velocity{0}, effort{0}, jerk{0}, acceleration{0};  ///< measured
  double stop_position{0};  ///< held while there is no command
  double contact_threshold{std::numeric_limits<double>::infinity()};    ///< [Nm]
  double collision_threshold{std::numeric_limits<double>::infinity()};  ///< [Nm]
  boost::optional<ControlMethod> control_method;                        ///< none: not controlled
  control_toolbox::Pid position_controller, velocity_controller;        ///< of motions

  /// @name Desired values in robot states, by mode and control method
  /// @{
  double getDesiredPosition(const franka::RobotMode& mode) const;
  double getDesiredVelocity(const franka::RobotMode& mode) const;
  double getDesiredAcceleration(const franka::RobotMode& mode) const;
  double getDesiredTorque(const franka::RobotMode& mode) const;
  /// @}

  /// Not known to a drive: always NaN.
  double getLinkMass() const;
  bool isInContact() const;    ///< effort above contact_threshold
  bool isInCollision() const;  ///< effort above collision_threshold
  /// The next update uses this as position, desired position and stop_position. Thread-safe.
  void setJointPosition(double position);

 private:
  bool controlledBy(const franka::RobotMode& mode, ControlMethod method) const;

  boost::optional<double> last_velocity_, last_acceleration_;
  std::mutex requested_mutex_;
  boost::optional<double> requested_position_;
};

}  // namespace franka_gazebo
