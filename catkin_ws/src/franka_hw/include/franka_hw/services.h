// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <franka/exception.h>
#include <franka/robot.h>
#include <franka_hw/robot_mutex.h>
#include <franka_hw/setters.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace franka_hw {

/// Offers a service whose response has `success` and `error`. An exception of the handler becomes
/// success = false with the text of the exception; every call gets a response.
/// @tparam T the service's message type @param handler does the work, in a thread of the node
/// handle
template <typename T>
ros::ServiceServer advertiseService(
    ros::NodeHandle& node_handle, const std::string& name,
    std::function<void(typename T::Request&, typename T::Response&)> handler) {
  return node_handle.advertiseService<typename T::Request, typename T::Response>(
      name, [name, handler](typename T::Request& request, typename T::Response& response) {
        try {
          handler(request, response);
          response.success = true;
          ROS_DEBUG_STREAM(name << " succeeded.");
        } catch (const std::exception& error) {
          ROS_ERROR_STREAM(name << " failed: " << error.what());
          response.success = false;
          response.error = error.what();
        }
        return true;
      });
}

/// Owns service servers.
class ServiceContainer {
 public:
  /// As franka_hw::advertiseService<T>. @returns this container, so that calls can be chained
  template <typename T, typename... TArgs>
  ServiceContainer& advertiseService(TArgs&&... args) {
    services_.push_back(franka_hw::advertiseService<T>(std::forward<TArgs>(args)...));
    return *this;
  }

  /// Expires with this container. A handler that works still may outlast it: roscpp 1.15 does not
  /// wait for its end.
  std::weak_ptr<const void> lifetime() const noexcept { return lifetime_; }

 private:
  std::shared_ptr<const void> lifetime_{std::make_shared<int>()};
  std::vector<ros::ServiceServer> services_;
};

/// Offers the seven services that configure the robot: set_joint_impedance,
/// set_cartesian_impedance, set_EE_frame, set_K_frame, set_force_torque_collision_behavior,
/// set_full_collision_behavior and set_load. While a motion holds the robot they are refused at
/// once, with instructions for the user, instead of waiting for its end.
/// @param robot outlives the services, and is deleted under the mutex
/// @param robot_mutex is held by threads that use the robot; outlives the last call
void setupServices(franka::Robot& robot, RobotMutex& robot_mutex, ros::NodeHandle& node_handle,
                   ServiceContainer& services);
/// The same for any mutex. It does not show whether a motion holds it: the services are refused
/// after half a second.
void setupServices(franka::Robot& robot, std::mutex& robot_mutex, ros::NodeHandle& node_handle,
                   ServiceContainer& services);

/// @name Implementation of the services
/// @throws franka::Exception if the robot refuses or cannot be reached
/// @{
void setCartesianImpedance(franka::Robot& robot,
                           const franka_msgs::SetCartesianImpedance::Request& req,
                           franka_msgs::SetCartesianImpedance::Response& res);
void setJointImpedance(franka::Robot& robot, const franka_msgs::SetJointImpedance::Request& req,
                       franka_msgs::SetJointImpedance::Response& res);
void setEEFrame(franka::Robot& robot, const franka_msgs::SetEEFrame::Request& req,
                franka_msgs::SetEEFrame::Response& res);
void setKFrame(franka::Robot& robot, const franka_msgs::SetKFrame::Request& req,
               franka_msgs::SetKFrame::Response& res);
void setForceTorqueCollisionBehavior(
    franka::Robot& robot, const franka_msgs::SetForceTorqueCollisionBehavior::Request& req,
    franka_msgs::SetForceTorqueCollisionBehavior::Response& res);
void setFullCollisionBehavior(franka::Robot& robot,
                              const franka_msgs::SetFullCollisionBehavior::Request& req,
                              franka_msgs::SetFullCollisionBehavior::Response& res);
void setLoad(franka::Robot& robot, const franka_msgs::SetLoad::Request& req,
             franka_msgs::SetLoad::Response& res);
/// @}

}  // namespace franka_hw
