// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/node_handle.h>

#include <list>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace combined_robot_hw_test {

using hardware_interface::ControllerInfo;
typedef std::list<ControllerInfo> Controllers;

/// A robot that records calls and returns values set by a test.
class Robot : public hardware_interface::RobotHW {
 public:
  Robot() = default;
  explicit Robot(const std::vector<std::string>& joints) { registerJoints(joints); }

  /// Parameters: `joints`; `fail`, one of "", "false", "exception", "word".
  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override {
    root_namespace = root_nh.getNamespace();
    const std::string fail = robot_hw_nh.param("fail", std::string());
    if (fail == "exception") {
      throw std::runtime_error("no cable");
    }
    if (fail == "word") {
      throw "just a word";
    }
    registerJoints(robot_hw_nh.param("joints", std::vector<std::string>()));
    return fail != "false";
  }

  void registerJoints(const std::vector<std::string>& joints) {
    position.resize(joints.size());
    command.resize(joints.size());
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const hardware_interface::JointStateHandle state(joints[i], &position[i], &zero, &zero);
      states.registerHandle(state);
      efforts.registerHandle({state, &command[i]});
      positions.registerHandle({state, &command[i]});
    }
    registerInterface(&states);
    registerInterface(&efforts);
    registerInterface(&positions);
  }

  bool checkForConflict(const Controllers& info) const override {
    checked = info;
    return lenient ? false : RobotHW::checkForConflict(info);
  }
  bool prepareSwitch(const Controllers& start, const Controllers& stop) override {
    prepared.emplace_back(start, stop);
    if (throws) {
      throw std::runtime_error("brakes are closed");
    }
    return agrees;
  }
  void doSwitch(const Controllers& start, const Controllers& stop) override {
    ++switches;
    last_start = &start;
    last_stop = &stop;
  }
  SwitchState switchResult() const override { return result; }
  SwitchState switchResult(const ControllerInfo& info) const override {
    claim_count = info.claimed_resources.size();
    return result;
  }
  void read(const ros::Time& time, const ros::Duration& /*period*/) override {
    for (double& value : position) {
      value = time.toSec();
    }
  }
  void write(const ros::Time& /*time*/, const ros::Duration& period) override {
    written = command.empty() ? 0.0 : command[0];
    write_period = period.toSec();
  }

  std::string root_namespace;
  bool lenient{false}, agrees{true}, throws{false};
  SwitchState result{SwitchState::DONE};
  mutable Controllers checked;
  mutable std::size_t claim_count{0};
  std::vector<std::pair<Controllers, Controllers>> prepared;
  int switches{0};
  const Controllers* last_start{nullptr};
  const Controllers* last_stop{nullptr};
  std::vector<double> position, command;
  double written{0.0}, write_period{0.0};

 private:
  double zero{0.0};
  hardware_interface::JointStateInterface states;
  hardware_interface::EffortJointInterface efforts;
  hardware_interface::PositionJointInterface positions;
};

}  // namespace combined_robot_hw_test
