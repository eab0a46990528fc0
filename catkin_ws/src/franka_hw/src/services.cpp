// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/robot_mutex.h>
#include <franka_hw/services.h>

#include <array>

namespace franka_hw {

namespace {

/// Locks a robot's mutex for a short operation.
using Take = std::function<std::unique_lock<std::mutex>()>;

/// @throws franka::InvalidOperationException for a robot that could not be had in time
std::unique_lock<std::mutex> orRefuse(std::unique_lock<std::mutex> lock) {
  if (!lock) {
    throw franka::InvalidOperationException(
        "The robot cannot be configured now: it is silent, or something else keeps it busy. See "
        "that it answers and nothing moves it, then try again.");
  }
  return lock;
}

void refuseInMotion(const RobotMutex& robot_mutex) {
  if (robot_mutex.inMotion()) {
    throw franka::InvalidOperationException(
        "The robot cannot be configured while a controller commands it. Stop that controller "
        "(rosservice call /controller_manager/switch_controller), then try again.");
  }
}

/// A handler that has the robot for itself while it works.
template <typename T>
auto exclusively(franka::Robot& robot, const Take& take,
                 void (*set)(franka::Robot&, const typename T::Request&, typename T::Response&)) {
  return [&robot, take, set](typename T::Request& request, typename T::Response& response) {
    const std::unique_lock<std::mutex> lock = take();
    set(robot, request, response);
  };
}

/// A message's fixed array as std::array.
template <std::size_t size, typename Source>
std::array<double, size> arrayOf(const Source& source) {
  std::array<double, size> values;
  std::copy_n(source.begin(), size, values.begin());
  return values;
}

void offerSetters(franka::Robot& robot, const Take& take, ros::NodeHandle& node_handle,
                  ServiceContainer& services) {
  using namespace franka_msgs;
  services
      .advertiseService<SetJointImpedance>(
          node_handle, "set_joint_impedance",
          exclusively<SetJointImpedance>(robot, take, setJointImpedance))
      .advertiseService<SetCartesianImpedance>(
          node_handle, "set_cartesian_impedance",
          exclusively<SetCartesianImpedance>(robot, take, setCartesianImpedance))
      .advertiseService<SetEEFrame>(node_handle, "set_EE_frame",
                                    exclusively<SetEEFrame>(robot, take, setEEFrame))
      .advertiseService<SetKFrame>(node_handle, "set_K_frame",
                                   exclusively<SetKFrame>(robot, take, setKFrame))
      .advertiseService<SetForceTorqueCollisionBehavior>(
          node_handle, "set_force_torque_collision_behavior",
          exclusively<SetForceTorqueCollisionBehavior>(robot, take,
                                                       setForceTorqueCollisionBehavior))
      .advertiseService<SetFullCollisionBehavior>(
          node_handle, "set_full_collision_behavior",
          exclusively<SetFullCollisionBehavior>(robot, take, setFullCollisionBehavior))
      .advertiseService<SetLoad>(node_handle, "set_load",
                                 exclusively<SetLoad>(robot, take, setLoad));
}

}  // namespace

void setupServices(franka::Robot& robot, RobotMutex& robot_mutex, ros::NodeHandle& node_handle,
                   ServiceContainer& services) {
  const auto take = [&robot_mutex] {
    const RobotMutex::Request request(robot_mutex);
    return orRefuse(
        RobotMutex::takeSoon(robot_mutex, [&robot_mutex] { refuseInMotion(robot_mutex); }));
  };
  offerSetters(robot, take, node_handle, services);
}

void setupServices(franka::Robot& robot, std::mutex& robot_mutex, ros::NodeHandle& node_handle,
                   ServiceContainer& services) {
  const auto take = [&robot_mutex] { return orRefuse(RobotMutex::takeSoon(robot_mutex, [] {})); };
  offerSetters(robot, take, node_handle, services);
}

void setCartesianImpedance(franka::Robot& robot,
                           const franka_msgs::SetCartesianImpedance::Request& req,
                           franka_msgs::SetCartesianImpedance::Response& /*res*/) {
  robot.setCartesianImpedance(arrayOf<6>(req.cartesian_stiffness));
}

void setJointImpedance(franka::Robot& robot, const franka_msgs::SetJointImpedance::Request& req,
                       franka_msgs::SetJointImpedance::Response& /*res*/) {
  robot.setJointImpedance(arrayOf<7>(req.joint_stiffness));
}

void setEEFrame(franka::Robot& robot, const franka_msgs::SetEEFrame::Request& req,
                franka_msgs::SetEEFrame::Response& /*res*/) {
  robot.setEE(arrayOf<16>(req.NE_T_EE));
}

void setKFrame(franka::Robot& robot, const franka_msgs::SetKFrame::Request& req,
               franka_msgs::SetKFrame::Response& /*res*/) {
  robot.setK(arrayOf<16>(req.EE_T_K));
}

void setForceTorqueCollisionBehavior(
    franka::Robot& robot, const franka_msgs::SetForceTorqueCollisionBehavior::Request& req,
    franka_msgs::SetForceTorqueCollisionBehavior::Response& /*res*/) {
  robot.setCollisionBehavior(arrayOf<7>(req.lower_torque_thresholds_nominal),
                             arrayOf<7>(req.upper_torque_thresholds_nominal),
                             arrayOf<6>(req.lower_force_thresholds_nominal),
                             arrayOf<6>(req.upper_force_thresholds_nominal));
}

void setFullCollisionBehavior(franka::Robot& robot,
                              const franka_msgs::SetFullCollisionBehavior::Request& req,
                              franka_msgs::SetFullCollisionBehavior::Response& /*res*/) {
  robot.setCollisionBehavior(arrayOf<7>(req.lower_torque_thresholds_acceleration),
                             arrayOf<7>(req.upper_torque_thresholds_acceleration),
                             arrayOf<7>(req.lower_torque_thresholds_nominal),
                             arrayOf<7>(req.upper_torque_thresholds_nominal),
                             arrayOf<6>(req.lower_force_thresholds_acceleration),
                             arrayOf<6>(req.upper_force_thresholds_acceleration),
                             arrayOf<6>(req.lower_force_thresholds_nominal),
                             arrayOf<6>(req.upper_force_thresholds_nominal));
}

void setLoad(franka::Robot& robot, const franka_msgs::SetLoad::Request& req,
             franka_msgs::SetLoad::Response& /*res*/) {
  robot.setLoad(req.mass, arrayOf<3>(req.F_x_center_load), arrayOf<9>(req.load_inertia));
}

}  // namespace franka_hw
