// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/robot_access.h>
#include <franka_hw/services.h>

#include <array>
#include <chrono>
#include <thread>

namespace franka_hw {

namespace {

// Who only reads a state holds the robot for a millisecond or two, and longer where the machine is
// busy with other work or the robot silent.
constexpr std::chrono::milliseconds kPatience{500};

/// The robot for a short operation. @throws franka::InvalidOperationException while it is moving.
std::unique_lock<std::mutex> takeRobot(std::mutex& robot_mutex) {
  const RobotAccessRequest request;
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  std::unique_lock<std::mutex> lock(robot_mutex, std::defer_lock);
  while (!lock.try_lock()) {
    if (RobotInMotion::holds(robot_mutex)) {
      throw franka::InvalidOperationException(
          "The robot cannot be configured while a controller commands it. Stop that controller "
          "(rosservice call /controller_manager/switch_controller), then try again.");
    }
    if (std::chrono::steady_clock::now() > deadline) {
      throw franka::InvalidOperationException(
          "The robot cannot be configured now: it is silent, or something else keeps it busy. See "
          "that it answers and nothing moves it, then try again.");
    }
    std::this_thread::sleep_for(RobotAccessRequest::kMoment);
  }
  return lock;
}

/// A handler that has the robot for itself while it works.
template <typename T>
auto exclusively(franka::Robot& robot, std::mutex& robot_mutex,
                 void (*set)(franka::Robot&, const typename T::Request&, typename T::Response&)) {
  return [&robot, &robot_mutex, set](typename T::Request& request, typename T::Response& response) {
    const std::unique_lock<std::mutex> lock = takeRobot(robot_mutex);
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

}  // namespace

void setupServices(franka::Robot& robot, std::mutex& robot_mutex, ros::NodeHandle& node_handle,
                   ServiceContainer& services) {
  using namespace franka_msgs;
  services
      .advertiseService<SetJointImpedance>(
          node_handle, "set_joint_impedance",
          exclusively<SetJointImpedance>(robot, robot_mutex, setJointImpedance))
      .advertiseService<SetCartesianImpedance>(
          node_handle, "set_cartesian_impedance",
          exclusively<SetCartesianImpedance>(robot, robot_mutex, setCartesianImpedance))
      .advertiseService<SetEEFrame>(node_handle, "set_EE_frame",
                                    exclusively<SetEEFrame>(robot, robot_mutex, setEEFrame))
      .advertiseService<SetKFrame>(node_handle, "set_K_frame",
                                   exclusively<SetKFrame>(robot, robot_mutex, setKFrame))
      .advertiseService<SetForceTorqueCollisionBehavior>(
          node_handle, "set_force_torque_collision_behavior",
          exclusively<SetForceTorqueCollisionBehavior>(robot, robot_mutex,
                                                       setForceTorqueCollisionBehavior))
      .advertiseService<SetFullCollisionBehavior>(
          node_handle, "set_full_collision_behavior",
          exclusively<SetFullCollisionBehavior>(robot, robot_mutex, setFullCollisionBehavior))
      .advertiseService<SetLoad>(node_handle, "set_load",
                                 exclusively<SetLoad>(robot, robot_mutex, setLoad));
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
