// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>
#include <controller_interface/internal/robothw_interfaces.h>
#include <hardware_interface/robot_hw.h>
#include <ros/console.h>
#include <ros/node_handle.h>

namespace controller_interface {

/// Base of controllers that work on several hardware interfaces. In init it gets a robot that has
/// only the interfaces named here.
/// @tparam T each derives from hardware_interface::HardwareInterface
template <typename... T>
class MultiInterfaceController : public virtual ControllerBase {
  static_assert(sizeof...(T) > 0, "A controller needs at least one hardware interface.");

 public:
  /// @param allow_optional_interfaces whether the robot may lack some of the interfaces; get<...>()
  /// of such a type is nullptr in init.
  MultiInterfaceController(bool allow_optional_interfaces = false)
      : allow_optional_interfaces_(allow_optional_interfaces) {}

  /// Gets the controller's handles; override this one or the one with three arguments (both are
  /// called, this one first). Outside the control loop.
  /// @returns false, after logging the reason, if the controller cannot work.
  virtual bool init(hardware_interface::RobotHW* /*robot_hw*/, ros::NodeHandle& /*controller_nh*/) {
    return true;
  }

  /// The same with the node handle of the controller manager.
  virtual bool init(hardware_interface::RobotHW* /*robot_hw*/, ros::NodeHandle& /*root_nh*/,
                    ros::NodeHandle& /*controller_nh*/) {
    return true;
  }

 protected:
  bool initRequest(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh,
                   ros::NodeHandle& controller_nh, ClaimedResources& claimed_resources) override {
    if (state_ != ControllerState::CONSTRUCTED) {
      ROS_ERROR("Cannot initialize this controller because it failed to be constructed");
      return false;
    }
    if (!allow_optional_interfaces_ && !hasRequiredInterfaces(robot_hw)) {
      return false;
    }
    extractInterfaceResources(robot_hw, &robot_hw_ctrl_);
    clearClaims(&robot_hw_ctrl_);
    if (!init(&robot_hw_ctrl_, controller_nh) || !init(&robot_hw_ctrl_, root_nh, controller_nh)) {
      ROS_ERROR("Failed to initialize the controller");
      clearClaims(&robot_hw_ctrl_);
      return false;
    }
    populateClaimedResources(&robot_hw_ctrl_, claimed_resources);
    clearClaims(&robot_hw_ctrl_);
    state_ = ControllerState::INITIALIZED;
    return true;
  }

  static bool hasRequiredInterfaces(hardware_interface::RobotHW* robot_hw) {
    return internal::hasInterfaces<T...>(robot_hw);
  }

  static void clearClaims(hardware_interface::RobotHW* robot_hw) {
    internal::clearClaims<T...>(robot_hw);
  }

  static void extractInterfaceResources(hardware_interface::RobotHW* robot_hw_in,
                                        hardware_interface::RobotHW* robot_hw_out) {
    internal::extractInterfaceResources<T...>(robot_hw_in, robot_hw_out);
  }

  static void populateClaimedResources(hardware_interface::RobotHW* robot_hw,
                                       ClaimedResources& claimed_resources) {
    internal::populateClaimedResources<T...>(robot_hw, claimed_resources);
  }

  hardware_interface::RobotHW robot_hw_ctrl_;  ///< holds the named interfaces only
  bool allow_optional_interfaces_;
};

}  // namespace controller_interface
