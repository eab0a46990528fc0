// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>
#include <hardware_interface/internal/demangle_symbol.h>
#include <hardware_interface/robot_hw.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include <string>

namespace controller_interface {

/// Base of controllers that work on one hardware interface.
/// @tparam T derives from hardware_interface::HardwareInterface
template <class T>
class Controller : public virtual ControllerBase {
 public:
  Controller() = default;

  /// Gets the controller's handles; override this one or the one with three arguments (both are
  /// called, this one first). Outside the control loop.
  /// @returns false, after logging the reason, if the controller cannot work.
  virtual bool init(T* /*hw*/, ros::NodeHandle& /*controller_nh*/) { return true; }

  /// The same with the node handle of the controller manager.
  virtual bool init(T* /*hw*/, ros::NodeHandle& /*root_nh*/, ros::NodeHandle& /*controller_nh*/) {
    return true;
  }

 protected:
  bool initRequest(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh,
                   ros::NodeHandle& controller_nh, ClaimedResources& claimed_resources) override {
    if (state_ != ControllerState::CONSTRUCTED) {
      ROS_ERROR("Cannot initialize this controller because it failed to be constructed");
      return false;
    }
    T* hw = robot_hw->get<T>();
    if (hw == nullptr) {
      ROS_ERROR(
          "This controller requires a hardware interface of type '%s'. Make sure this is "
          "registered in the hardware_interface::RobotHW class.",
          getHardwareInterfaceType().c_str());
      return false;
    }
    hw->clearClaims();
    if (!init(hw, controller_nh) || !init(hw, root_nh, controller_nh)) {
      ROS_ERROR("Failed to initialize the controller");
      hw->clearClaims();
      return false;
    }
    claimed_resources.assign(
        1, hardware_interface::InterfaceResources(getHardwareInterfaceType(), hw->getClaims()));
    hw->clearClaims();
    state_ = ControllerState::INITIALIZED;
    return true;
  }

  /// C++ name of T, with namespaces.
  std::string getHardwareInterfaceType() const {
    return hardware_interface::internal::demangledTypeName<T>();
  }
};

}  // namespace controller_interface
