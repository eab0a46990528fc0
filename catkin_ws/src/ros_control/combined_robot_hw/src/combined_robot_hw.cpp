// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <combined_robot_hw/combined_robot_hw.h>
#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace combined_robot_hw {

using hardware_interface::ControllerInfo;
using hardware_interface::InterfaceResources;
using hardware_interface::RobotHW;
using hardware_interface::RobotHWSharedPtr;

namespace {

RobotHW::SwitchState worse(RobotHW::SwitchState a, RobotHW::SwitchState b) {
  if (a == RobotHW::SwitchState::ERROR || b == RobotHW::SwitchState::ERROR) {
    return RobotHW::SwitchState::ERROR;
  }
  return a == RobotHW::SwitchState::DONE ? b : a;
}

template <class Range, class Value>
bool contains(const Range& range, const Value& value) {
  return std::find(range.begin(), range.end(), value) != range.end();
}

std::vector<std::string> namesOf(const std::list<ControllerInfo>& list) {
  std::vector<std::string> names;
  for (const ControllerInfo& controller : list) {
    names.push_back(controller.name);
  }
  return names;
}

bool areNames(const std::vector<std::string>& names, const std::list<ControllerInfo>& list) {
  return std::equal(names.begin(), names.end(), list.begin(), list.end(),
                    [](const std::string& name, const ControllerInfo& controller) {
                      return name == controller.name;
                    });
}

/// Calls a member outside the control loop; an exception is a refusal.
bool agrees(RobotHW& robot, const std::list<ControllerInfo>& start_list,
            const std::list<ControllerInfo>& stop_list) {
  try {
    return robot.prepareSwitch(start_list, stop_list);
  } catch (const std::exception& error) {
    ROS_ERROR("A robot of a combined robot threw while it prepared a switch of controllers: %s",
              error.what());
    return false;
  }
}

}  // namespace

void CombinedRobotHW::filterControllerList(const std::list<ControllerInfo>& list,
                                           std::list<ControllerInfo>& filtered_list,
                                           RobotHWSharedPtr robot_hw) const {
  filtered_list.clear();
  const std::vector<std::string> interfaces = robot_hw->getNames();
  for (const ControllerInfo& controller : list) {
    if (controller.claimed_resources.empty()) {
      filtered_list.push_back(controller);
      continue;
    }
    ControllerInfo filtered;
    filtered.name = controller.name;
    filtered.type = controller.type;
    for (const InterfaceResources& claimed : controller.claimed_resources) {
      if (!contains(interfaces, claimed.hardware_interface)) {
        continue;
      }
      const std::vector<std::string> registered =
          robot_hw->getInterfaceResources(claimed.hardware_interface);
      InterfaceResources kept(claimed.hardware_interface, {});
      for (const std::string& resource : claimed.resources) {
        if (contains(registered, resource)) {
          kept.resources.insert(resource);
        }
      }
      if (!kept.resources.empty()) {
        filtered.claimed_resources.push_back(std::move(kept));
      }
    }
    if (!filtered.claimed_resources.empty()) {
      filtered_list.push_back(std::move(filtered));
    }
  }
}

bool CombinedRobotHW::belongsToOneMember(const std::string& resource) const {
  const auto has_resource = [&](const RobotHWSharedPtr& robot) {
    const std::vector<std::string> interfaces = robot->getNames();
    return std::any_of(interfaces.begin(), interfaces.end(), [&](const std::string& type) {
      return contains(robot->getInterfaceResources(type), resource);
    });
  };
  return std::count_if(robot_hw_list_.begin(), robot_hw_list_.end(), has_resource) == 1;
}

bool CombinedRobotHW::checkForConflict(const std::list<ControllerInfo>& info) const {
  bool in_conflict = false;
  for (const RobotHWSharedPtr& robot : robot_hw_list_) {
    ControllerList filtered;
    filterControllerList(info, filtered, robot);
    in_conflict = robot->checkForConflict(filtered) || in_conflict;
  }
  ControllerList others = info;
  for (ControllerInfo& controller : others) {
    for (InterfaceResources& claimed : controller.claimed_resources) {
      for (auto it = claimed.resources.begin(); it != claimed.resources.end();) {
        it = belongsToOneMember(*it) ? claimed.resources.erase(it) : std::next(it);
      }
    }
  }
  return RobotHW::checkForConflict(others) || in_conflict;
}

CombinedRobotHW::Plan CombinedRobotHW::makePlan(const ControllerList& start_list,
                                                const ControllerList& stop_list) const {
  Plan plan{namesOf(start_list), namesOf(stop_list), std::vector<Share>(robot_hw_list_.size())};
  for (std::size_t i = 0; i < robot_hw_list_.size(); ++i) {
    filterControllerList(start_list, plan.shares[i].start, robot_hw_list_[i]);
    filterControllerList(stop_list, plan.shares[i].stop, robot_hw_list_[i]);
  }
  return plan;
}

bool CombinedRobotHW::isPlanned(const ControllerList& start_list,
                                const ControllerList& stop_list) const {
  return plan_.shares.size() == robot_hw_list_.size() && areNames(plan_.start_names, start_list) &&
         areNames(plan_.stop_names, stop_list);
}

bool CombinedRobotHW::prepareSwitch(const std::list<ControllerInfo>& start_list,
                                    const std::list<ControllerInfo>& stop_list) {
  Plan plan = makePlan(start_list, stop_list);
  for (std::size_t i = 0; i < robot_hw_list_.size(); ++i) {
    const Share& share = plan.shares[i];
    if (!share.empty() && !agrees(*robot_hw_list_[i], share.start, share.stop)) {
      takeBack(plan, i);
      return false;
    }
  }
  plan_ = std::move(plan);
  return true;
}

void CombinedRobotHW::takeBack(const Plan& plan, std::size_t members) {
  while (members > 0) {
    --members;
    const Share& share = plan.shares[members];
    if (!share.empty() && !agrees(*robot_hw_list_[members], share.stop, share.start)) {
      ROS_ERROR(
          "Robot number %zu of a combined robot had prepared a switch that another one refused, "
          "and now refuses the way back. Stop the controllers of this robot before you switch "
          "again.",
          members + 1);
    }
  }
}

void CombinedRobotHW::doSwitch(const std::list<ControllerInfo>& start_list,
                               const std::list<ControllerInfo>& stop_list) {
  if (!isPlanned(start_list, stop_list)) {
    // Only for callers that did not prepare this switch; allocates.
    plan_ = makePlan(start_list, stop_list);
  }
  for (std::size_t i = 0; i < robot_hw_list_.size(); ++i) {
    const Share& share = plan_.shares[i];
    if (!share.empty()) {
      robot_hw_list_[i]->doSwitch(share.start, share.stop);
    }
  }
}

RobotHW::SwitchState CombinedRobotHW::switchResult() const {
  SwitchState state = SwitchState::DONE;
  for (std::size_t i = 0; i < plan_.shares.size() && i < robot_hw_list_.size(); ++i) {
    if (!plan_.shares[i].empty()) {
      state = worse(state, robot_hw_list_[i]->switchResult());
    }
  }
  return state;
}

RobotHW::SwitchState CombinedRobotHW::switchResult(const ControllerInfo& controller) const {
  SwitchState state = SwitchState::DONE;
  for (std::size_t i = 0; i < plan_.shares.size() && i < robot_hw_list_.size(); ++i) {
    for (const ControllerInfo& started : plan_.shares[i].start) {
      if (started.name == controller.name) {
        state = worse(state, robot_hw_list_[i]->switchResult(started));
      }
    }
  }
  return state;
}

void CombinedRobotHW::read(const ros::Time& time, const ros::Duration& period) {
  for (const RobotHWSharedPtr& robot : robot_hw_list_) {
    robot->read(time, period);
  }
}

void CombinedRobotHW::write(const ros::Time& time, const ros::Duration& period) {
  for (const RobotHWSharedPtr& robot : robot_hw_list_) {
    robot->write(time, period);
  }
}

}  // namespace combined_robot_hw
