// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "manager_fixture.h"

using dummies::DummyController;
using dummies::LogCatcher;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace {

class LoadTest : public dummies::ManagerTest {};

}  // namespace

TEST_F(LoadTest, KeepsControllersInTheOrderOfLoading) {
  load({"c", "a"});
  EXPECT_THAT(loaded(), ElementsAre("c", "a"));
  const auto specs = manager_->getControllers();
  EXPECT_EQ("dummy/Good", specs[0].info.type);
  ASSERT_EQ(1u, specs[0].info.claimed_resources.size());
  EXPECT_EQ("hardware_interface::EffortJointInterface",
            specs[0].info.claimed_resources[0].hardware_interface);
  EXPECT_THAT(specs[0].info.claimed_resources[0].resources, ElementsAre("j1"));
  EXPECT_TRUE(controller("a").isInitialized());
  EXPECT_EQ(nullptr, manager_->getControllerByName("unknown"));
}

TEST_F(LoadTest, FailuresAreLoggedAndKeepTheList) {
  describe("refusing", "dummy/Refusing", {});
  describe("throwing", "dummy/Throwing", {});
  describe("broken", "dummy/Broken", {});
  describe("typo", "dummy/God", {});
  describe("no_joint", "dummy/Good", {"elbow"});
  nh_.setParam("number/type", 3);
  load({"a"});
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"a", "already loaded"},
      {"nobody", "namespace: '/manager_test/nobody'"},
      {"number", "type was not specified"},
      {"refusing", "Initializing controller 'refusing' failed"},
      {"throwing", "no such joint"},
      {"no_joint", "'elbow' in 'hardware_interface::EffortJointInterface'"},
      {"broken", "'dummy/Broken': the library is broken"},
      {"typo", "'dummy/God' does not exist"},
      {"bad name!", "name cannot be used"},
      {"", "type was not specified"},
  };
  for (const auto& one : cases) {
    LogCatcher log;
    EXPECT_FALSE(manager_->loadController(one.first)) << one.first;
    EXPECT_THAT(log.text(), HasSubstr(one.second));
    EXPECT_THAT(loaded(), ElementsAre("a"));
  }
  EXPECT_EQ(1, DummyController::living());
}

TEST_F(LoadTest, LoadsANameAgainAfterAFailure) {
  describe("x", "dummy/Refusing", {});
  EXPECT_FALSE(manager_->loadController("x"));
  describe("x", "dummy/Good", {});
  EXPECT_TRUE(manager_->loadController("x"));
}

TEST_F(LoadTest, EarlierLoadersAreSearchedFirst) {
  const auto second = std::make_shared<dummies::DummyLoader>();
  manager_->registerControllerLoader(second);
  load({"a"});
  EXPECT_EQ(1, loader_->listings_);
  EXPECT_EQ(0, second->listings_);
}

TEST_F(LoadTest, RefusesToUnloadRunningAndUnknownControllers) {
  load({"a"});
  ASSERT_TRUE(doSwitch({"a"}, {}));
  LogCatcher log;
  EXPECT_FALSE(manager_->unloadController("a"));
  EXPECT_FALSE(manager_->unloadController("z"));
  EXPECT_THAT(log.text(), HasSubstr("name 'a' because it is still running"));
  EXPECT_THAT(log.text(), HasSubstr("name 'z' because no controller"));
  ASSERT_TRUE(doSwitch({}, {"a"}));
  EXPECT_TRUE(manager_->unloadController("a"));
  EXPECT_THAT(loaded(), IsEmpty());
  EXPECT_EQ(0, DummyController::living()) << "no finished switch may keep it alive";
}

TEST_F(LoadTest, ReloadOfLoadedControllersRequiresForce) {
  load({"a", "c"});
  LogCatcher log;
  EXPECT_FALSE(manager_->reloadControllerLibraries(false));
  EXPECT_THAT(log.text(), HasSubstr("still 2 controllers"));
  EXPECT_EQ(0, loader_->reloads_);
  EXPECT_TRUE(manager_->reloadControllerLibraries(true)) << "nothing runs, so no loop is needed";
  EXPECT_EQ(1, loader_->reloads_);
  EXPECT_EQ(0, DummyController::living());
  EXPECT_TRUE(manager_->reloadControllerLibraries(false));
  EXPECT_EQ(2, loader_->reloads_);
}

TEST_F(LoadTest, ForcedReloadStopsRunningControllers) {
  load({"a", "c"});
  ASSERT_TRUE(doSwitch({"a"}, {}));
  EXPECT_TRUE(stepUntil(std::async(std::launch::async,
                                   [this] { return manager_->reloadControllerLibraries(true); })));
  EXPECT_EQ(0, DummyController::living());
  EXPECT_EQ(1, loader_->reloads_);
}
