// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <combined_robot_hw/combined_robot_hw.h>

#include <list>
#include <string>
#include <vector>

#include "signature.h"

using combined_robot_hw::CombinedRobotHW;
using hardware_interface::ControllerInfo;
typedef std::list<ControllerInfo> Infos;

EXPECT_BASE(hardware_interface::RobotHW, CombinedRobotHW);
struct Combined : CombinedRobotHW {
  bool loadRobotHW(const std::string& name) override {
    Infos filtered;
    filterControllerList(Infos(), filtered, robot_hw_list_.front());
    EXPECT_TYPE(ros::NodeHandle&, (root_nh_));
    EXPECT_TYPE(ros::NodeHandle&, (robot_hw_nh_));
    EXPECT_TYPE(std::vector<hardware_interface::RobotHWSharedPtr>&, (robot_hw_list_));
    EXPECT_TYPE(pluginlib::ClassLoader<hardware_interface::RobotHW>&, (robot_hw_loader_));
    return CombinedRobotHW::loadRobotHW(name);
  }
};
