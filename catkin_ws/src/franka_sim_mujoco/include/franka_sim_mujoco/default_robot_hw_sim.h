// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/device_joints.h>
#include <franka_sim_mujoco/robot_hw_sim.h>

#include <list>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// Hardware of robots without a Franka arm, in place of gazebo_ros_control's default: all joints of
/// the URDF's SimpleTransmissions, driven by DeviceJoints. Threads and real-time safety:
/// RobotHWSim.
class DefaultRobotHWSim : public RobotHWSim {
 public:
  bool initSim(const std::string& robot_namespace, ros::NodeHandle model_nh, RobotHandle robot,
               const urdf::Model* urdf_model,
               std::vector<transmission_interface::TransmissionInfo> transmissions) override;
  std::string failure() const override { return failure_; }
  void readSim(ros::Time time, ros::Duration period) override;
  void writeSim(ros::Time time, ros::Duration period) override;
  void worldWasReset() override;
  void doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                const std::list<hardware_interface::ControllerInfo>& stop_list) override;

 private:
  std::string failure_;
  std::unique_ptr<DeviceJoints> joints_;
  hardware_interface::JointStateInterface states_;
  hardware_interface::EffortJointInterface efforts_;
  hardware_interface::PositionJointInterface positions_;
  hardware_interface::VelocityJointInterface velocities_;
  hardware_interface::JointEffortLimitInterface effort_limits_;
};

}  // namespace franka_sim_mujoco
