// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The default loader finds controllers in plugin libraries, including those written for ROS 1.
#include "manager_fixture.h"

using testing::HasSubstr;

namespace {

class PluginTest : public dummies::ManagerTest {};

}  // namespace

TEST_F(PluginTest, LoadsRunsAndReloadsAPlugin) {
  nh_.setParam("plugged/type", "controller_manager_test/PluginController");
  ASSERT_TRUE(manager_->loadController("plugged"));
  ASSERT_TRUE(doSwitch({"plugged"}, {}));
  step();
  EXPECT_TRUE(manager_->getControllerByName("plugged")->isRunning());
  EXPECT_TRUE(stepUntil(std::async(std::launch::async,
                                   [this] { return manager_->reloadControllerLibraries(true); })));
  EXPECT_TRUE(manager_->loadController("plugged"));
}

TEST_F(PluginTest, IsListed) {
  bool found = false;
  for (const auto& declared : manager_->getDeclaredTypes()) {
    found = found || (declared.type == "controller_manager_test/PluginController" &&
                      declared.base_class == "controller_interface::ControllerBase");
  }
  EXPECT_TRUE(found);
}

TEST_F(PluginTest, NamesAMissingLibrary) {
  nh_.setParam("absent/type", "controller_manager_test/AbsentController");
  dummies::LogCatcher log;
  EXPECT_FALSE(manager_->loadController("absent"));
  EXPECT_THAT(log.text(), HasSubstr("'controller_manager_test/AbsentController': "));
}
