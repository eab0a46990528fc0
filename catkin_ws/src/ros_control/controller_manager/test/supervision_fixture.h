// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// A controller that fails on demand, and a supervised manager.

#include <limits>
#include <stdexcept>

#include "manager_fixture.h"

namespace dummies {

enum class FaultKind { kNone, kThrow, kThrowNumber, kNan, kSlow };

/// Works normally until a fault is set.
class FaultyController : public DummyController {
 public:
  static FaultKind& inUpdate() {
    static FaultKind mischief{FaultKind::kNone};
    return mischief;
  }
  /// Name of the callback that throws, other than update.
  static std::string& throwsIn() {
    static std::string callback;
    return callback;
  }

  bool init(hardware_interface::EffortJointInterface* hw, ros::NodeHandle& nh) override {
    std::vector<std::string> joints;
    nh.getParam("joints", joints);
    handle_ = hw->getHandle(joints.at(0));
    return true;
  }
  void starting(const ros::Time& time) override {
    throwIfIn("starting");
    handle_.setCommand(kFirstCommand);
    DummyController::starting(time);
  }
  void stopping(const ros::Time& time) override {
    throwIfIn("stopping");
    DummyController::stopping(time);
  }
  void waiting(const ros::Time& time) override {
    throwIfIn("waiting");
    DummyController::waiting(time);
  }
  void aborting(const ros::Time& time) override {
    throwIfIn("aborting");
    DummyController::aborting(time);
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    ++updates_;
    handle_.setCommand(inUpdate() == FaultKind::kNan ? std::numeric_limits<double>::quiet_NaN()
                                                     : 7.0);
    if (inUpdate() == FaultKind::kThrow) {
      throw std::runtime_error("the matrix is singular");
    }
    if (inUpdate() == FaultKind::kThrowNumber) {
      throw 42;
    }
    if (inUpdate() == FaultKind::kSlow) {
      std::this_thread::sleep_for(std::chrono::milliseconds(3));  // the fault itself
    }
  }

  static constexpr double kFirstCommand = 3.0;  ///< by starting(); updates command 7

 private:
  static void throwIfIn(const char* callback) {
    if (throwsIn() == callback) {
      throw std::runtime_error("the target is unknown");
    }
  }

  hardware_interface::JointHandle handle_;
};

class FaultyLoader : public controller_manager::ControllerLoaderInterface {
 public:
  FaultyLoader() : ControllerLoaderInterface("FaultyController") {}
  controller_interface::ControllerBaseSharedPtr createInstance(const std::string&) override {
    return std::make_shared<FaultyController>();
  }
  std::vector<std::string> getDeclaredClasses() override { return {"dummy/Faulty"}; }
  void reload() override {}
};

class SupervisionTest : public ManagerTest {
 protected:
  SupervisionTest() : own_(nh_, "controller_manager") {
    FaultyController::inUpdate() = FaultKind::kNone;
    FaultyController::throwsIn().clear();
    describe("faulty", "dummy/Faulty", {"j3"});
  }
  ~SupervisionTest() override {
    for (const char* const name : {"statistics_rate", "abort_faulty_controllers", "max_update_time",
                                   "default_switch_timeout"}) {
      own_.deleteParam(name);
    }
    nh_.deleteParam("faulty/fallback_controllers");
  }

  /// Creates a manager that reads the test's parameters.
  void renew() {
    manager_.reset();
    manager_ = std::make_unique<controller_manager::ControllerManager>(&robot_, nh_);
    manager_->registerControllerLoader(loader_);
    manager_->registerControllerLoader(std::make_shared<FaultyLoader>());
  }
  void renewGuarded() {
    own_.setParam("abort_faulty_controllers", true);
    renew();
    load({"a", "faulty"});
    ASSERT_TRUE(doSwitch({"a", "faulty"}, {}));
  }

  /// Steps until the switch has returned. @returns number of steps that threw
  int stepThroughExceptions(const std::future<bool>& answer) {
    int thrown = 0;
    waitFor([&] {
      try {
        step();
      } catch (const std::runtime_error&) {
        ++thrown;
      }
      return isReady(answer);
    });
    return thrown;
  }

  double command(const std::string& joint) {
    auto* const efforts = robot_.get<hardware_interface::EffortJointInterface>();
    return efforts->getHandle(joint).getCommand();
  }

  /// Steps until the robot has been notified of the abort.
  void stepUntilNotified(int switches) {
    waitFor([&] {
      step();
      return robot_.switches_ > switches;
    });
  }

  /// One faulty cycle: the controller is aborted in it, and the other one continues.
  void failOnce(FaultKind mischief) {
    step();
    const int updates = controller("a").updates_;
    const int switches = robot_.switches_;
    FaultyController::inUpdate() = mischief;
    EXPECT_NO_THROW(step());
    EXPECT_TRUE(controller("faulty").isAborted());
    EXPECT_EQ(1, controller("faulty").aborts_);
    EXPECT_EQ(updates + 1, controller("a").updates_);
    stepUntilNotified(switches);
    EXPECT_EQ("faulty", robot_.prepared_stop_.back());
    EXPECT_EQ(1, robot_.stopped_);
    EXPECT_TRUE(controller("a").isRunning());
  }

  ros::NodeHandle own_;
};

}  // namespace dummies
