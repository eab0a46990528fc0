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
/// them; of a switch each member gets only the part for its own resources. A member without a part
/// is not called, so that a switch of one robot cannot disturb another one (the original calls it
/// with empty lists).
///
/// init, checkForConflict and prepareSwitch run outside the control loop. doSwitch, switchResult,
/// read and write run in it and add neither allocations nor locks to those of the members; for
/// doSwitch this requires an earlier prepareSwitch with the same lists, as controller managers do.
class CombinedRobotHW : public hardware_interface::RobotHW {
 public:
  CombinedRobotHW() = default;

  /// Loads the robots named in the parameter `robot_hardware` of `robot_hw_nh`. Each has its
  /// parameters in the namespace `robot_hw_nh/<name>`, among them its plugin's `type`. @returns
  /// false, with a sentence in the log and no member kept, if one of them is unusable.
  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;

  /// A resource of exactly one member is checked by that member's own rules. All other resources
  /// are checked by the rule of RobotHW: one controller each.
  bool checkForConflict(const std::list<hardware_interface::ControllerInfo>& info) const override;

  /// Calls the members one by one, with their controllers. If one refuses, those before it get the
  /// reverse switch, so that none stays prepared.
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) override;

  void doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                const std::list<hardware_interface::ControllerInfo>& stop_list) override;

  /// The worst result of the members that took part in the last switch: an error, else ongoing,
  /// else done.
  SwitchState switchResult() const override;

  /// The worst result of those members for which the last switch started this controller.
  SwitchState switchResult(const hardware_interface::ControllerInfo& controller) const override;

  void read(const ros::Time& time, const ros::Duration& period) override;
  void write(const ros::Time& time, const ros::Duration& period) override;

 protected:
  /// Loads one robot and adds it to the list. @returns false, with a sentence, if that fails.
  virtual bool loadRobotHW(const std::string& name);

  /// The part of `list` for one robot: controllers without claims, and of the others the claims on
  /// the robot's resources. @param[out] filtered_list gets the result
  void filterControllerList(const std::list<hardware_interface::ControllerInfo>& list,
                            std::list<hardware_interface::ControllerInfo>& filtered_list,
                            hardware_interface::RobotHWSharedPtr robot_hw) const;

  ros::NodeHandle root_nh_;
  ros::NodeHandle robot_hw_nh_;
  // Declared before the list: the loader must outlive its robots.
  pluginlib::ClassLoader<hardware_interface::RobotHW> robot_hw_loader_{
      "hardware_interface", "hardware_interface::RobotHW"};
  std::vector<hardware_interface::RobotHWSharedPtr> robot_hw_list_;

 private:
  typedef std::list<hardware_interface::ControllerInfo> ControllerList;

  /// A member's part of a switch.
  struct Share {
    ControllerList start;
    ControllerList stop;
    bool empty() const noexcept { return start.empty() && stop.empty(); }
  };

  /// A switch, split for each member of robot_hw_list_.
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
