// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/controller_info.h>
#include <hardware_interface/hardware_interface.h>
#include <hardware_interface/internal/interface_manager.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <list>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace hardware_interface {

/// A robot as controllers see it: a set of hardware interfaces, updated by read() and applied by
/// write() once per control cycle. Where the comment of a function carries the real-time note,
/// every robot's implementation must comply with it.
class RobotHW : public InterfaceManager {
 public:
  RobotHW() = default;
  ~RobotHW() override = default;

  /// Prepares the robot and registers its interfaces. Not real-time safe.
  /// @returns false if the robot cannot be used.
  virtual bool init(ros::NodeHandle& /*root_nh*/, ros::NodeHandle& /*robot_hw_nh*/) { return true; }

  /// Whether the controllers conflict. Default: a resource is claimed more than once, on any
  /// interface; each conflict is logged. Runs outside the control loop.
  virtual bool checkForConflict(const std::list<ControllerInfo>& info) const {
    typedef std::map<std::string, std::vector<std::string>> Claimants;
    Claimants claimants;
    for (const ControllerInfo& controller : info) {
      for (const InterfaceResources& claimed : controller.claimed_resources) {
        for (const std::string& resource : claimed.resources) {
          claimants[resource].push_back(controller.name);
        }
      }
    }
    bool in_conflict = false;
    for (const Claimants::value_type& entry : claimants) {
      if (entry.second.size() < 2) {
        continue;
      }
      std::string names;
      for (const std::string& name : entry.second) {
        names += name + ", ";
      }
      ROS_WARN_STREAM("Resource conflict on [" << entry.first << "].  Controllers = [" << names
                                               << "]");
      in_conflict = true;
    }
    return in_conflict;
  }

  /// Called before a switch, outside the control loop, with the controllers that will be started
  /// and stopped (restarted: in both). For slow preparations. @returns false to refuse the switch.
  virtual bool prepareSwitch(const std::list<ControllerInfo>& /*start_list*/,
                             const std::list<ControllerInfo>& /*stop_list*/) {
    return true;
  }

  /// Called by the control loop once, at the start of a switch. Real-time safe.
  virtual void doSwitch(const std::list<ControllerInfo>& /*start_list*/,
                        const std::list<ControllerInfo>& /*stop_list*/) {}

  /// Progress of a switch of controllers.
  enum class SwitchState { DONE, ONGOING, ERROR };

  /// Progress of the switch for all controllers. Called by the control loop. Real-time safe.
  virtual SwitchState switchResult() const { return SwitchState::DONE; }

  /// Progress of the switch for one controller. Called by the control loop. Real-time safe.
  virtual SwitchState switchResult(const ControllerInfo& /*controller*/) const {
    return SwitchState::DONE;
  }

  /// Reads the robot's state. Called by the control loop, with the time of this cycle and the
  /// period since the one before. Real-time safe.
  virtual void read(const ros::Time& /*time*/, const ros::Duration& /*period*/) {}

  /// Sends the controllers' commands. Called by the control loop, with the time of this cycle and
  /// the period since the one before. Real-time safe.
  virtual void write(const ros::Time& /*time*/, const ros::Duration& /*period*/) {}
};

typedef std::shared_ptr<RobotHW> RobotHWSharedPtr;

}  // namespace hardware_interface
