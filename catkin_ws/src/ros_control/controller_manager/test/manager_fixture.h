// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/controller_manager.h>
#include <gmock/gmock.h>
#include <ros/node_handle.h>
#include <ros_test/eventually.h>
#include <ros_test/log_catcher.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "dummies.h"

namespace dummies {

using ros_test::LogCatcher;

constexpr int kStrict = 2;
constexpr int kBestEffort = 1;

/// A manager with dummies a, b (joint j0), c (j1) and d (j2) on the parameter server. Time advances
/// only by the test's steps.
class ManagerTest : public testing::Test {
 protected:
  typedef std::vector<std::string> Names;

  ManagerTest() : nh_("manager_test"), loader_(std::make_shared<DummyLoader>()) {
    describe("a", "dummy/Good", {"j0"});
    describe("b", "dummy/Good", {"j0"});
    describe("c", "dummy/Good", {"j1"});
    describe("d", "dummy/Good", {"j2"});
    manager_ = std::make_unique<controller_manager::ControllerManager>(&robot_, nh_);
    manager_->registerControllerLoader(loader_);
  }

  void describe(const std::string& name, const std::string& type, const Names& joints) {
    nh_.setParam(name + "/type", type);
    nh_.setParam(name + "/joints", joints);
  }

  void load(const Names& names) {
    for (const std::string& name : names) {
      ASSERT_TRUE(manager_->loadController(name)) << name;
    }
  }

  /// One cycle of the loop.
  void step(bool reset = false) {
    time_ += ros::Duration(0.001);
    manager_->update(time_, ros::Duration(0.001), reset);
  }

  std::future<bool> postSwitch(const Names& start, const Names& stop, int strictness = kStrict,
                               bool asap = false, double timeout = 0.0) {
    return std::async(std::launch::async, [=] {
      return manager_->switchController(start, stop, strictness, asap, timeout);
    });
  }

  static bool isReady(const std::future<bool>& answer) {
    return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  /// Steps until the switch has returned.
  bool stepUntil(std::future<bool> answer) {
    waitFor([&] {
      step();
      return isReady(answer);
    });
    return answer.get();
  }

  bool doSwitch(const Names& start, const Names& stop, int strictness = kStrict, bool asap = false,
                double timeout = 0.0) {
    return stepUntil(postSwitch(start, stop, strictness, asap, timeout));
  }

  template <class Condition>
  static void waitFor(Condition condition) {
    if (!ros_test::eventually(condition, std::chrono::microseconds(100))) {
      ADD_FAILURE() << "what the test waits for did not happen";
      std::abort();
    }
  }

  /// Posts a switch and steps until the cycle that starts it is over.
  /// @param[out] updates_before of the controller `watched`, before that cycle
  std::future<bool> beginSwitch(const Names& start, const Names& stop, int strictness = kStrict,
                                bool asap = false, double timeout = 0.0,
                                const DummyController* watched = nullptr,
                                int* updates_before = nullptr) {
    const int switches = robot_.switches_;
    std::future<bool> answer = postSwitch(start, stop, strictness, asap, timeout);
    waitFor([&] {
      if (watched != nullptr) {
        *updates_before = watched->updates_;
      }
      step();
      return robot_.switches_ > switches;
    });
    return answer;
  }

  /// Posts a switch and waits, without stepping, until it is passed to the loop.
  std::future<bool> postAndWait(const Names& start, const Names& stop) {
    const int prepares = robot_.prepares_;
    std::future<bool> answer = postSwitch(start, stop);
    waitFor([&] { return robot_.prepares_ > prepares; });
    return answer;
  }

  DummyController& controller(const std::string& name) {
    return dynamic_cast<DummyController&>(*manager_->getControllerByName(name));
  }

  Names loaded() const {
    Names names;
    for (const controller_manager::ControllerSpec& spec : manager_->getControllers()) {
      names.push_back(spec.info.name);
    }
    return names;
  }

  ros::NodeHandle nh_;
  DummyRobot robot_;
  std::shared_ptr<DummyLoader> loader_;
  std::unique_ptr<controller_manager::ControllerManager> manager_;
  ros::Time time_{100.0};
};

}  // namespace dummies
