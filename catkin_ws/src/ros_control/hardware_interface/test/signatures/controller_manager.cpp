// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/controller_loader.h>
#include <controller_manager/controller_loader_interface.h>
#include <controller_manager/controller_manager.h>
#include <controller_manager/controller_spec.h>

#include <memory>
#include <string>

#include "signature.h"

using namespace controller_manager;
using controller_interface::ControllerBase;
using controller_interface::ControllerBaseSharedPtr;

EXPECT_TYPE(ControllerLoaderInterfaceSharedPtr, std::shared_ptr<ControllerLoaderInterface>());
EXPECT_BASE(ControllerLoaderInterface, ControllerLoader<ControllerBase>);
EXPECT_TYPE(ControllerBaseSharedPtr, ControllerLoader<ControllerBase>(std::string(), std::string())
                                         .createInstance(std::string()));

static_assert(ControllerManager::WAIT_FOR_ALL_RESOURCES == false, "");
static_assert(ControllerManager::INFINITE_TIMEOUT == 0.0, "");
static_assert(std::has_virtual_destructor<ControllerManager>::value, "");
static_assert(std::is_constructible<ControllerManager, hardware_interface::RobotHW*>::value, "");
static_assert(std::is_constructible<ControllerManager, hardware_interface::RobotHW*,
                                    const ros::NodeHandle&>::value,
              "");
// Includes that users of the original's header rely on.
EXPECT_TYPE(bool, static_cast<bool>(of<controller_manager_msgs::LoadController>().response.ok));
EXPECT_TYPE(bool, static_cast<bool>(of<controller_manager_msgs::UnloadController>().response.ok));
EXPECT_TYPE(bool, static_cast<bool>(of<controller_manager_msgs::SwitchController>().response.ok));
EXPECT_TYPE(controller_manager_msgs::ListControllers&,
            of<controller_manager_msgs::ListControllers>());
EXPECT_TYPE(controller_manager_msgs::ListControllerTypes&,
            of<controller_manager_msgs::ListControllerTypes>());
EXPECT_TYPE(controller_manager_msgs::ReloadControllerLibraries&,
            of<controller_manager_msgs::ReloadControllerLibraries>());
struct Manager : ControllerManager {
  using ControllerManager::ControllerManager;
  ControllerBase* getControllerByName(const std::string& name) override {
    return ControllerManager::getControllerByName(name);
  }
};
