// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <combined_robot_hw/combined_robot_hw.h>
#include <ros/console.h>
#include <ros/names.h>

#include <algorithm>
#include <exception>
#include <set>
#include <stdexcept>

namespace combined_robot_hw {

using hardware_interface::RobotHWSharedPtr;

bool CombinedRobotHW::init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) {
  root_nh_ = root_nh;
  robot_hw_nh_ = robot_hw_nh;

  const std::string& where = robot_hw_nh.getNamespace();
  std::vector<std::string> names;
  if (!robot_hw_nh.hasParam("robot_hardware")) {
    ROS_ERROR("Could not find 'robot_hardware' parameter (namespace: %s).", where.c_str());
    return false;
  }
  if (!robot_hw_nh.getParam("robot_hardware", names) || names.empty()) {
    ROS_ERROR(
        "Parameter 'robot_hardware' (namespace: %s) must be a list of at least one name, for "
        "example [left, right]. Each name is also the namespace of that robot's parameters.",
        where.c_str());
    return false;
  }
  std::set<std::string> loaded;
  for (const std::string& name : names) {
    if (!loaded.insert(name).second) {
      ROS_ERROR(
          "Parameter 'robot_hardware' (namespace: %s) names '%s' twice. Give every robot a "
          "name of its own.",
          where.c_str(), name.c_str());
      dropMembers();
      return false;
    }
    if (!loadRobotHW(name)) {
      dropMembers();
      return false;
    }
  }
  return true;
}

void CombinedRobotHW::dropMembers() {
  for (const RobotHWSharedPtr& robot : robot_hw_list_) {
    interface_managers_.erase(
        std::remove(interface_managers_.begin(), interface_managers_.end(), robot.get()),
        interface_managers_.end());
  }
  robot_hw_list_.clear();
}

bool CombinedRobotHW::loadRobotHW(const std::string& name) {
  ros::NodeHandle robot_nh;
  try {
    robot_nh = ros::NodeHandle(robot_hw_nh_, name);
  } catch (const ros::InvalidNameException& error) {
    ROS_ERROR("Could not load robot HW '%s', because its name cannot be a namespace: %s",
              name.c_str(), error.what());
    return false;
  }
  std::string type;
  if (!robot_nh.getParam("type", type)) {
    ROS_ERROR(
        "Could not load robot HW '%s' because the type was not specified. Did you load the robot "
        "HW configuration on the parameter server (namespace: '%s')?",
        name.c_str(), robot_nh.getNamespace().c_str());
    return false;
  }
  const RobotHWSharedPtr robot = createRobotHW(name, type);
  if (!robot) {
    return false;
  }
  try {
    if (!robot->init(root_nh_, robot_nh)) {
      ROS_ERROR("Initializing robot HW '%s' failed", name.c_str());
      return false;
    }
  } catch (const std::exception& error) {
    ROS_ERROR("Exception thrown while initializing robot HW '%s'.\n%s", name.c_str(), error.what());
    return false;
  } catch (...) {
    ROS_ERROR("Exception thrown while initializing robot HW '%s'", name.c_str());
    return false;
  }
  robot_hw_list_.push_back(robot);
  registerInterfaceManager(robot.get());
  return true;
}

RobotHWSharedPtr CombinedRobotHW::createRobotHW(const std::string& name, const std::string& type) {
  const std::vector<std::string> types = robot_hw_loader_.getDeclaredClasses();
  if (std::find(types.begin(), types.end(), type) == types.end()) {
    std::string available;
    for (const std::string& declared : types) {
      available += (available.empty() ? "" : ", ") + declared;
    }
    ROS_ERROR("Could not load robot HW '%s' because robot HW type '%s' does not exist.",
              name.c_str(), type.c_str());
    ROS_ERROR("Available types of robot HW: %s", available.empty() ? "none" : available.c_str());
    return nullptr;
  }
  try {
    return robot_hw_loader_.createUniqueInstance(type);
  } catch (const std::runtime_error& error) {
    ROS_ERROR("Could not load class '%s': %s", type.c_str(), error.what());
    return nullptr;
  }
}

}  // namespace combined_robot_hw
