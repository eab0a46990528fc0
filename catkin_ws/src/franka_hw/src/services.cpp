// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/robot_mutex.h>
#include <franka_hw/services.h>

namespace franka_hw {

namespace {

/// Locks a robot's mutex for a short operation.
using Take = std::function<std::unique_lock<std::mutex>()>;

/// @throws franka::InvalidOperationException if the robot could not be locked in time
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

/// Offers handlers that hold the robot's mutex while they work.
void offerSetters(franka::Robot& robot, const Take& take, ros::NodeHandle& node_handle,
                  ServiceContainer& services) {
  forEachSetter([&](auto setter) {
    using Service = typename decltype(setter)::Service;
    services.advertiseService<Service>(
        node_handle, setter.name,
        [&robot, take, offered = services.lifetime()](const typename Service::Request& request,
                                                      const auto& /*response*/) {
          const std::unique_lock<std::mutex> lock = take();
          if (offered.expired()) {
            throw franka::InvalidOperationException(
                "The robot was disconnected before this request reached it. Call the service "
                "connect, then try again.");
          }
          configure(robot, checkedRequest(request));
        });
  });
}

}  // namespace

void setupServices(franka::Robot& robot, RobotMutex& robot_mutex, ros::NodeHandle& node_handle,
                   ServiceContainer& services) {
  const auto take = [&robot_mutex] {
    const RobotMutex::Request request(robot_mutex);
    return orRefuse(
        RobotMutex::lockSoon(robot_mutex, [&robot_mutex] { refuseInMotion(robot_mutex); }));
  };
  offerSetters(robot, take, node_handle, services);
}

void setupServices(franka::Robot& robot, std::mutex& robot_mutex, ros::NodeHandle& node_handle,
                   ServiceContainer& services) {
  const auto take = [&robot_mutex] { return orRefuse(RobotMutex::lockSoon(robot_mutex, [] {})); };
  offerSetters(robot, take, node_handle, services);
}

void setCartesianImpedance(franka::Robot& robot,
                           const franka_msgs::SetCartesianImpedance::Request& req,
                           franka_msgs::SetCartesianImpedance::Response& /*res*/) {
  configure(robot, req);
}

void setJointImpedance(franka::Robot& robot, const franka_msgs::SetJointImpedance::Request& req,
                       franka_msgs::SetJointImpedance::Response& /*res*/) {
  configure(robot, req);
}

void setEEFrame(franka::Robot& robot, const franka_msgs::SetEEFrame::Request& req,
                franka_msgs::SetEEFrame::Response& /*res*/) {
  configure(robot, checkedRequest(req));
}

void setKFrame(franka::Robot& robot, const franka_msgs::SetKFrame::Request& req,
               franka_msgs::SetKFrame::Response& /*res*/) {
  configure(robot, checkedRequest(req));
}

void setForceTorqueCollisionBehavior(
    franka::Robot& robot, const franka_msgs::SetForceTorqueCollisionBehavior::Request& req,
    franka_msgs::SetForceTorqueCollisionBehavior::Response& /*res*/) {
  configure(robot, req);
}

void setFullCollisionBehavior(franka::Robot& robot,
                              const franka_msgs::SetFullCollisionBehavior::Request& req,
                              franka_msgs::SetFullCollisionBehavior::Response& /*res*/) {
  configure(robot, req);
}

void setLoad(franka::Robot& robot, const franka_msgs::SetLoad::Request& req,
             franka_msgs::SetLoad::Response& /*res*/) {
  configure(robot, req);
}

}  // namespace franka_hw
