// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_interface/controller.h>
#include <controller_interface/controller_base.h>
#include <controller_interface/internal/robothw_interfaces.h>
#include <controller_interface/multi_interface_controller.h>
#include <hardware_interface/joint_command_interface.h>

#include <memory>
#include <string>
#include <vector>

#include "signature.h"

using namespace controller_interface;
using hardware_interface::EffortJointInterface;
using hardware_interface::JointStateInterface;
using hardware_interface::RobotHW;

// The base.
static_assert(std::is_default_constructible<Controller<EffortJointInterface>>::value == false, "");
static_assert(!std::is_copy_constructible<ControllerBase>::value, "");
static_assert(!std::is_move_constructible<ControllerBase>::value, "");
static_assert(std::has_virtual_destructor<ControllerBase>::value, "");
EXPECT_TYPE(ControllerBaseSharedPtr, std::shared_ptr<ControllerBase>());
EXPECT_TYPE(ControllerBase::ClaimedResources,
            std::vector<hardware_interface::InterfaceResources>());

// Controllers of one interface.
struct Single : Controller<EffortJointInterface> {
  void update(const ros::Time&, const ros::Duration&) override {}

 protected:
  bool initRequest(RobotHW* robot_hw, ros::NodeHandle& root_nh, ros::NodeHandle& controller_nh,
                   ClaimedResources& claimed_resources) override {
    EXPECT_TYPE(std::string, of<const Single>().getHardwareInterfaceType());
    return Controller::initRequest(robot_hw, root_nh, controller_nh, claimed_resources);
  }
};
// ControllerBase is a virtual base: mix-ins may derive from it too.
struct MixIn : public virtual ControllerBase {};
struct Mixed : MixIn, Single {
  ControllerBase& base() { return *this; }
};

// Controllers of several interfaces.
typedef MultiInterfaceController<EffortJointInterface, JointStateInterface> Two;
struct Multi : Two {
  Multi() : MultiInterfaceController(true) {}
  void update(const ros::Time&, const ros::Duration&) override {}

 protected:
  bool initRequest(RobotHW* robot_hw, ros::NodeHandle& root_nh, ros::NodeHandle& controller_nh,
                   ClaimedResources& claimed_resources) override {
    EXPECT_TYPE(RobotHW&, (robot_hw_ctrl_));
    EXPECT_TYPE(bool&, (allow_optional_interfaces_));
    if (!hasRequiredInterfaces(robot_hw)) {
      return false;
    }
    extractInterfaceResources(robot_hw, &robot_hw_ctrl_);
    clearClaims(robot_hw);
    populateClaimedResources(robot_hw, claimed_resources);
    return Two::initRequest(robot_hw, root_nh, controller_nh, claimed_resources);
  }
};
struct One : MultiInterfaceController<EffortJointInterface> {
  void update(const ros::Time&, const ros::Duration&) override {}
};

EXPECT_TYPE(bool,
            internal::hasInterfaces<EffortJointInterface, JointStateInterface>(of<RobotHW*>()));
EXPECT_TYPE(void, internal::clearClaims<EffortJointInterface>(of<RobotHW*>()));
EXPECT_TYPE(void, internal::extractInterfaceResources<EffortJointInterface>(of<RobotHW*>(),
                                                                            of<RobotHW*>()));
EXPECT_TYPE(void, internal::populateClaimedResources<EffortJointInterface>(
                      of<RobotHW*>(), of<ControllerBase::ClaimedResources>()));
