// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Requests without calls of update(): which are answered, and which wait.
#include <controller_manager_msgs/SwitchController.h>
#include <ros/service.h>

#include "manager_fixture.h"

using dummies::DummyController;
using dummies::kStrict;
using dummies::LogCatcher;
using hardware_interface::RobotHW;
using testing::ElementsAre;
using testing::HasSubstr;

namespace {

class StandStillTest : public dummies::ManagerTest {
 protected:
  void SetUp() override { load({"a"}); }
};

/// Calls switch, load and unload from inside its update.
class RecursiveCaller : public DummyController {
 public:
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    if (manager_ != nullptr) {
      answers_ = manager_->switchController({}, {"meddler"}, kStrict) ||
                 manager_->loadController("c") || manager_->unloadController("a");
      manager_ = nullptr;
      meddled_ = true;
    }
  }
  controller_manager::ControllerManager* manager_{nullptr};
  bool answers_{true};
  bool meddled_{false};
};

class MeddlerLoader : public controller_manager::ControllerLoaderInterface {
 public:
  MeddlerLoader() : ControllerLoaderInterface("RecursiveCaller") {}
  controller_interface::ControllerBaseSharedPtr createInstance(const std::string&) override {
    return std::make_shared<RecursiveCaller>();
  }
  std::vector<std::string> getDeclaredClasses() override { return {"dummy/RecursiveCaller"}; }
  void reload() override {}
};

}  // namespace

TEST_F(StandStillTest, LoadUnloadAndListWorkWithoutTheLoop) {
  ASSERT_TRUE(doSwitch({"a"}, {}));
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(manager_->loadController("c"));
    EXPECT_THAT(loaded(), ElementsAre("a", "c"));
    EXPECT_TRUE(manager_->unloadController("c"));
  }
  EXPECT_EQ(1, DummyController::living());
}

TEST_F(StandStillTest, SwitchFailsAfterItsTimeout) {
  LogCatcher log;
  EXPECT_FALSE(manager_->switchController({"a"}, {}, kStrict, false, 0.2));
  EXPECT_THAT(log.text(), HasSubstr("did not run for 0.2"));
  step();
  EXPECT_TRUE(controller("a").isInitialized()) << "a withdrawn switch never happens";
  EXPECT_EQ(0, robot_.switches_);
  EXPECT_THAT(robot_.prepared_start_, ElementsAre("a", "")) << "and is taken back";
  EXPECT_THAT(robot_.prepared_stop_, ElementsAre("", "a"));
  EXPECT_TRUE(doSwitch({"a"}, {}));
}

TEST_F(StandStillTest, OtherRequestsAreServedDuringASwitch) {
  auto answer = postAndWait({"a"}, {});
  EXPECT_TRUE(manager_->loadController("c"));
  EXPECT_THAT(loaded(), ElementsAre("a", "c"));
  EXPECT_TRUE(manager_->unloadController("c"));
  LogCatcher log;
  EXPECT_FALSE(manager_->unloadController("a")) << "the switch still needs it";
  EXPECT_THAT(log.text(), HasSubstr("'a' because it takes part in a switch"));
  EXPECT_FALSE(manager_->switchController({}, {}, kStrict, false, 0.1)) << "one after the other";
  EXPECT_THAT(log.text(), HasSubstr("the switch before this one has not finished after "));
  EXPECT_FALSE(isReady(answer)) << "without a timeout it waits for ever";
  EXPECT_TRUE(stepUntil(std::move(answer)));
  EXPECT_TRUE(controller("a").isRunning());
}

TEST_F(StandStillTest, StartedSwitchIsAbortedWhenTheLoopReturns) {
  load({"c"});
  robot_.after_script_ = RobotHW::SwitchState::ONGOING;
  EXPECT_FALSE(beginSwitch({"a"}, {}, kStrict, false, 2.0).get());
  robot_.after_script_ = RobotHW::SwitchState::DONE;
  step();
  EXPECT_TRUE(controller("a").isAborted()) << "no caller waits for it any more";
  EXPECT_TRUE(manager_->unloadController("a"));
  EXPECT_EQ(1, DummyController::living());
  EXPECT_TRUE(doSwitch({"c"}, {}));
  EXPECT_TRUE(controller("c").isRunning());
}

TEST_F(StandStillTest, ShutdownEndsWaitingCalls) {
  controller_manager_msgs::SwitchController service;
  service.request.start_controllers = {"a"};
  service.request.strictness = kStrict;
  auto answer = std::async(std::launch::async, [&] {
    return ros::service::call("manager_test/controller_manager/switch_controller", service) &&
           service.response.ok;
  });
  waitFor([&] { return robot_.prepares_ > 0; });
  manager_.reset();
  EXPECT_EQ(0, DummyController::living());
  EXPECT_FALSE(answer.get());
}

TEST_F(StandStillTest, CallsFromTheLoopAreRefused) {
  manager_->registerControllerLoader(std::make_shared<MeddlerLoader>());
  describe("meddler", "dummy/RecursiveCaller", {});
  load({"meddler"});
  ASSERT_TRUE(doSwitch({"meddler"}, {}));
  auto& meddler = dynamic_cast<RecursiveCaller&>(*manager_->getControllerByName("meddler"));
  meddler.manager_ = manager_.get();
  LogCatcher log;
  step();
  EXPECT_TRUE(meddler.meddled_);
  EXPECT_FALSE(meddler.answers_);
  EXPECT_THAT(log.text(), HasSubstr("from a callback of the control loop"));
}
