// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/default_robot_hw_sim.h>
#include <ros/console.h>

#include <exception>
#include <pluginlib/class_list_macros.hpp>

#include "service_handlers.h"

namespace franka_sim_mujoco {

bool DefaultRobotHWSim::initSim(
    const std::string& /*robot_namespace*/, ros::NodeHandle model_nh, RobotHandle robot,
    const urdf::Model* urdf_model,
    std::vector<transmission_interface::TransmissionInfo> transmissions) {
  try {
    joints_ = std::make_unique<DeviceJoints>(model_nh, robot);
    for (const auto& transmission : transmissions) {
      if (transmission.type_ == "transmission_interface/SimpleTransmission") {
        joints_->add(transmission, *urdf_model);
      } else {
        ROS_WARN_NAMED("default_robot_hw_sim",
                       "%s: the transmission '%s' has the type '%s', which is not simulated: "
                       "ignored.",
                       robot.name.c_str(), transmission.name_.c_str(), transmission.type_.c_str());
      }
    }
    joints_->registerHandles(states_, efforts_, positions_, velocities_, effort_limits_);
  } catch (...) {
    failure_ = exceptionText();
    return false;
  }
  registerInterface(&states_);
  registerInterface(&efforts_);
  registerInterface(&positions_);
  registerInterface(&velocities_);
  registerInterface(&effort_limits_);
  return true;
}

void DefaultRobotHWSim::readSim(ros::Time /*time*/, ros::Duration /*period*/) { joints_->read(); }

void DefaultRobotHWSim::writeSim(ros::Time /*time*/, ros::Duration period) {
  joints_->write(period);
}

void DefaultRobotHWSim::worldWasReset() { joints_->worldWasReset(); }

void DefaultRobotHWSim::doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                                 const std::list<hardware_interface::ControllerInfo>& stop_list) {
  joints_->doSwitch(start_list, stop_list);
}

}  // namespace franka_sim_mujoco

PLUGINLIB_EXPORT_CLASS(franka_sim_mujoco::DefaultRobotHWSim, franka_sim_mujoco::RobotHWSim)
