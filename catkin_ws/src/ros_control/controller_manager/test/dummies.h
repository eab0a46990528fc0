// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Scripted controllers, loader and robot for the tests of the manager.

#include <controller_interface/controller.h>
#include <controller_manager/controller_loader_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros_test/eventually.h>

#include <atomic>
#include <list>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace dummies {

/// Claims the joints of its parameter `joints` and counts its callbacks. Real-time safe.
class DummyController
    : public controller_interface::Controller<hardware_interface::EffortJointInterface> {
 public:
  DummyController() { ++living(); }
  ~DummyController() override { --living(); }

  /// Number of instances.
  static std::atomic<int>& living() {
    static std::atomic<int> count{0};
    return count;
  }

  bool init(hardware_interface::EffortJointInterface* hw, ros::NodeHandle& controller_nh) override {
    std::vector<std::string> joints;
    controller_nh.getParam("joints", joints);
    for (const std::string& joint : joints) {
      handles_.push_back(hw->getHandle(joint));
    }
    return true;
  }
  void starting(const ros::Time& /*time*/) override {
    ++starts_;
    updates_at_start_ = updates_.load();
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    ++updates_;
    for (hardware_interface::JointHandle& handle : handles_) {
      handle.setCommand(1.0);
    }
  }
  void stopping(const ros::Time& /*time*/) override { ++stops_; }
  void waiting(const ros::Time& /*time*/) override { ++waits_; }
  void aborting(const ros::Time& /*time*/) override { ++aborts_; }

  std::atomic<int> starts_{0}, updates_{0}, stops_{0}, waits_{0}, aborts_{0};
  std::atomic<int> updates_at_start_{0};

 private:
  std::vector<hardware_interface::JointHandle> handles_;
};

class RefusingController : public DummyController {
  bool init(hardware_interface::EffortJointInterface* /*hw*/, ros::NodeHandle& /*nh*/) override {
    return false;
  }
};

class ThrowingController : public DummyController {
  bool init(hardware_interface::EffortJointInterface* /*hw*/, ros::NodeHandle& /*nh*/) override {
    throw std::invalid_argument("no such joint");
  }
};

/// Sets its parameter `loading` to true and is ready once a test sets it to false, or after a
/// deadline.
class SlowController : public DummyController {
  bool init(hardware_interface::EffortJointInterface* hw, ros::NodeHandle& nh) override {
    nh.setParam("loading", true);
    ros_test::eventually([&nh] { return !nh.param("loading", false); });
    return DummyController::init(hw, nh);
  }
};

/// Has the types dummy/Good, dummy/Refusing, dummy/Throwing, dummy/Slow and dummy/Broken (fails to
/// load).
class DummyLoader : public controller_manager::ControllerLoaderInterface {
 public:
  DummyLoader() : ControllerLoaderInterface("dummies::DummyController") {}

  controller_interface::ControllerBaseSharedPtr createInstance(const std::string& type) override {
    if (type == "dummy/Good") {
      return std::make_shared<DummyController>();
    }
    if (type == "dummy/Refusing") {
      return std::make_shared<RefusingController>();
    }
    if (type == "dummy/Throwing") {
      return std::make_shared<ThrowingController>();
    }
    if (type == "dummy/Slow") {
      return std::make_shared<SlowController>();
    }
    throw std::runtime_error("the library is broken");
  }
  std::vector<std::string> getDeclaredClasses() override {
    ++listings_;
    return {"dummy/Good", "dummy/Refusing", "dummy/Throwing", "dummy/Slow", "dummy/Broken"};
  }
  void reload() override { ++reloads_; }

  int listings_{0};
  int reloads_{0};
};

/// Has the joints j0, j1, ... and switches as scripted.
class DummyRobot : public hardware_interface::RobotHW {
 public:
  explicit DummyRobot(std::size_t joints = 4) : values_(joints, 0.0), commands_(joints, 0.0) {
    for (std::size_t i = 0; i < joints; ++i) {
      const hardware_interface::JointStateHandle state("j" + std::to_string(i), &values_[i],
                                                       &values_[i], &values_[i]);
      states_.registerHandle(state);
      efforts_.registerHandle(hardware_interface::JointHandle(state, &commands_[i]));
    }
    registerInterface(&states_);
    registerInterface(&efforts_);
  }

  typedef std::list<hardware_interface::ControllerInfo> Infos;

  bool prepareSwitch(const Infos& start, const Infos& stop) override {
    prepared_start_.push_back(names(start));
    prepared_stop_.push_back(names(stop));
    ++prepares_;
    return feasible_;
  }
  void doSwitch(const Infos& start, const Infos& stop) override {
    ++switches_;
    started_ = static_cast<int>(start.size());
    stopped_ = static_cast<int>(stop.size());
  }
  SwitchState switchResult() const override { return next(); }
  SwitchState switchResult(const hardware_interface::ControllerInfo& /*info*/) const override {
    return next();
  }

  static std::string names(const Infos& infos) {
    std::string joined;
    for (const hardware_interface::ControllerInfo& info : infos) {
      joined += (joined.empty() ? "" : " ") + info.name;
    }
    return joined;
  }

  bool feasible_{true};
  std::vector<std::string> prepared_start_, prepared_stop_;
  std::atomic<int> prepares_{0}, switches_{0}, started_{-1}, stopped_{-1};
  mutable std::atomic<int> result_calls_{0};
  std::vector<SwitchState> script_;  ///< results in order; then after_script_ for ever
  std::atomic<SwitchState> after_script_{SwitchState::DONE};

 private:
  SwitchState next() const {
    const std::size_t call = static_cast<std::size_t>(result_calls_++);
    return call < script_.size() ? script_[call] : after_script_.load();
  }

  std::vector<double> values_, commands_;
  hardware_interface::JointStateInterface states_;
  hardware_interface::EffortJointInterface efforts_;
};

}  // namespace dummies
