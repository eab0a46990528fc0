// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The services that configure an arm, real or simulated: their names, their types, and how a
// request becomes a call of the robot. Not real-time safe.

#include <franka_msgs/SetCartesianImpedance.h>
#include <franka_msgs/SetEEFrame.h>
#include <franka_msgs/SetForceTorqueCollisionBehavior.h>
#include <franka_msgs/SetFullCollisionBehavior.h>
#include <franka_msgs/SetJointImpedance.h>
#include <franka_msgs/SetKFrame.h>
#include <franka_msgs/SetLoad.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace franka_hw {

/// Name and type of one of the services.
template <typename T>
struct Setter {
  using Service = T;  ///< type of the service
  const char* name;   ///< of the service
};

/// Calls `visit` with the Setter of each of the services.
template <typename Visitor>
void forEachSetter(const Visitor& visit) {
  using namespace franka_msgs;
  visit(Setter<SetJointImpedance>{"set_joint_impedance"});
  visit(Setter<SetCartesianImpedance>{"set_cartesian_impedance"});
  visit(Setter<SetEEFrame>{"set_EE_frame"});
  visit(Setter<SetKFrame>{"set_K_frame"});
  visit(Setter<SetForceTorqueCollisionBehavior>{"set_force_torque_collision_behavior"});
  visit(Setter<SetFullCollisionBehavior>{"set_full_collision_behavior"});
  visit(Setter<SetLoad>{"set_load"});
}

/// Converts a message's fixed array to std::array.
template <std::size_t size, typename Source>
std::array<double, size> arrayOf(const Source& source) {
  std::array<double, size> values;
  std::copy_n(source.begin(), size, values.begin());
  return values;
}

/// @name The request that is sent to the robot
/// Of a frame: with the transform of the matrix that a user typed (franka_core/typed_transform.h);
/// logs the correction. Other requests are unchanged.
/// @throws franka::CommandException if the matrix is not a transform
/// @{
franka_msgs::SetEEFrame::Request checkedRequest(franka_msgs::SetEEFrame::Request request);
franka_msgs::SetKFrame::Request checkedRequest(franka_msgs::SetKFrame::Request request);
template <typename Request>
const Request& checkedRequest(const Request& request) {
  return request;
}
/// @}

/// @name Implementation of the services
/// Robot has the setters of franka::Robot, whose exceptions have texts for the user.
/// @{
template <typename Robot>
void configure(Robot& robot, const franka_msgs::SetJointImpedance::Request& request) {
  robot.setJointImpedance(arrayOf<7>(request.joint_stiffness));
}

template <typename Robot>
void configure(Robot& robot, const franka_msgs::SetCartesianImpedance::Request& request) {
  robot.setCartesianImpedance(arrayOf<6>(request.cartesian_stiffness));
}

template <typename Robot>
void configure(Robot& robot, const franka_msgs::SetEEFrame::Request& request) {
  robot.setEE(arrayOf<16>(request.NE_T_EE));
}

template <typename Robot>
void configure(Robot& robot, const franka_msgs::SetKFrame::Request& request) {
  robot.setK(arrayOf<16>(request.EE_T_K));
}

template <typename Robot>
void configure(Robot& robot, const franka_msgs::SetForceTorqueCollisionBehavior::Request& request) {
  robot.setCollisionBehavior(arrayOf<7>(request.lower_torque_thresholds_nominal),
                             arrayOf<7>(request.upper_torque_thresholds_nominal),
                             arrayOf<6>(request.lower_force_thresholds_nominal),
                             arrayOf<6>(request.upper_force_thresholds_nominal));
}

template <typename Robot>
void configure(Robot& robot, const franka_msgs::SetFullCollisionBehavior::Request& request) {
  robot.setCollisionBehavior(arrayOf<7>(request.lower_torque_thresholds_acceleration),
                             arrayOf<7>(request.upper_torque_thresholds_acceleration),
                             arrayOf<7>(request.lower_torque_thresholds_nominal),
                             arrayOf<7>(request.upper_torque_thresholds_nominal),
                             arrayOf<6>(request.lower_force_thresholds_acceleration),
                             arrayOf<6>(request.upper_force_thresholds_acceleration),
                             arrayOf<6>(request.lower_force_thresholds_nominal),
                             arrayOf<6>(request.upper_force_thresholds_nominal));
}

template <typename Robot>
void configure(Robot& robot, const franka_msgs::SetLoad::Request& request) {
  robot.setLoad(request.mass, arrayOf<3>(request.F_x_center_load),
                arrayOf<9>(request.load_inertia));
}
/// @}

}  // namespace franka_hw
