// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <combined_robot_hw/combined_robot_hw.h>
#include <franka_sim_mujoco/robot_hw_sim.h>

#include <list>
#include <memory>
#include <string>
#include <vector>

namespace franka_sim_mujoco {

/// The hardware of a robot with several arms: one FrankaHWSim for each, under one controller
/// manager. Controllers see the interfaces of all of them, and may command several arms. Joints of
/// other devices are the first one's. All arms read the parameters of the robot's namespace; the
/// services of each are below <namespace>/<arm_id>. Threads and real-time safety: RobotHWSim.
class CombinedHWSim : public RobotHWSim {
 public:
  /// @param members one for each arm of the robot that initSim gets, in their order
  explicit CombinedHWSim(std::vector<std::shared_ptr<RobotHWSim>> members);

  bool initSim(const std::string& robot_namespace, ros::NodeHandle model_nh, RobotHandle robot,
               const urdf::Model* urdf_model,
               std::vector<transmission_interface::TransmissionInfo> transmissions) override;
  std::string failure() const override { return failure_; }
  std::string condition() const override;
  void readSim(ros::Time time, ros::Duration period) override;
  void writeSim(ros::Time time, ros::Duration period) override;
  void eStopActive(bool active) override;
  void worldWasReset() override;
  std::vector<RobotHWSim*> parts() override;

  bool checkForConflict(
      const std::list<hardware_interface::ControllerInfo>& controllers) const override;
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) override;
  void doSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                const std::list<hardware_interface::ControllerInfo>& stop_list) override;
  SwitchState switchResult() const override;
  SwitchState switchResult(const hardware_interface::ControllerInfo& controller) const override;

 private:
  /// Splits switches between the members.
  class Switches : public combined_robot_hw::CombinedRobotHW {
   public:
    void add(const hardware_interface::RobotHWSharedPtr& member) {
      robot_hw_list_.push_back(member);
    }
  };

  std::string failure_;
  std::vector<std::shared_ptr<RobotHWSim>> members_;
  Switches switches_;
};

}  // namespace franka_sim_mujoco
