// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>

#include <list>
#include <pluginlib/class_loader.hpp>
#include <string>
#include <vector>

namespace combined_robot_hw {

/// One robot made of several, each loaded as a plugin. Controllers see the interfaces of all of
/// them; each member hears of a switch only what concerns its own resources.
///
/// init, checkForConflict and prepareSwitch run outside the control loop. doSwitch, switchResult,
/// read and write run in it and add neither allocations nor locks to those of the members; for
/// doSwitch that holds if prepareSwitch was asked about the same lists before, as controller
/// managers do.
class CombinedRobotHW : public hardware_interface::RobotHW {
 public:
  CombinedRobotHW() = default;

  /// Loads the robots that the parameter `robot_hardware` of `robot_hw_nh` names. Each has
  /// parameters of its own in the namespace `robot_hw_nh/<name>`, among them its plugin's `type`.
  /// @returns false, with a sentence in the log and no member kept, if one of them is unusable.
  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;

  /// A resource that exactly one member has is judged by that member, so its own rules count. The
  /// rule of RobotHW, each resource for one controller only, judges all other resources.
  bool checkForConflict(const std::list<hardware_interface::ControllerInfo>& info) const override;

  /// Asks the members one by one, with the controllers that concern them. If one refuses, those
  /// asked before it are asked for the way back, so that none stays prepared.
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) override;

  void doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                const std::list<hardware_interface::ControllerInfo>& stop_list) override;

  /// The worst of the members' answers: an error, else ongoing, else done.
  SwitchState switchResult() const override;

  /// The worst answer of those members that the last switch told to start this controller.
  SwitchState switchResult(const hardware_interface::ControllerInfo& controller) const override;

  void read(const ros::Time& time, const ros::Duration& period) override;
  void write(const ros::Time& time, const ros::Duration& period) override;

 protected:
  /// Loads one robot and adds it to the list. @returns false, with a sentence, if that fails.
  virtual bool loadRobotHW(const std::string& name);

  /// The part of `list` that concerns one robot: controllers that claim nothing at all, and of the
  /// others the claims on resources the robot registered. @param[out] filtered_list gets the result
  void filterControllerList(const std::list<hardware_interface::ControllerInfo>& list,
                            std::list<hardware_interface::ControllerInfo>& filtered_list,
                            hardware_interface::RobotHWSharedPtr robot_hw) const;

  ros::NodeHandle root_nh_;
  ros::NodeHandle robot_hw_nh_;
  // Before the list: the loader must outlive what it made.
  pluginlib::ClassLoader<hardware_interface::RobotHW> robot_hw_loader_{
      "hardware_interface", "hardware_interface::RobotHW"};
  std::vector<hardware_interface::RobotHWSharedPtr> robot_hw_list_;

 private:
  typedef std::list<hardware_interface::ControllerInfo> ControllerList;

  /// What one member hears of a switch.
  struct Share {
    ControllerList start;
    ControllerList stop;
  };

  /// A switch, worked out for each member of robot_hw_list_.
  struct Plan {
    std::vector<std::string> start_names;
    std::vector<std::string> stop_names;
    std::vector<Share> shares;
  };

  Plan makePlan(const ControllerList& start_list, const ControllerList& stop_list) const;
  bool isPlanned(const ControllerList& start_list, const ControllerList& stop_list) const;
  void takeBack(const Plan& plan, std::size_t members);
  hardware_interface::RobotHWSharedPtr createRobotHW(const std::string& name,
                                                     const std::string& type);
  void dropMembers();
  bool belongsToOneMember(const std::string& resource) const;

  Plan plan_;
};

}  // namespace combined_robot_hw
