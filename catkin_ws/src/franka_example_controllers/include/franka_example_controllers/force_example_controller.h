// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <dynamic_reconfigure/server.h>
#include <franka_example_controllers/desired_mass_paramConfig.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <realtime_tools/realtime_buffer.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// Presses down with the weight of a virtual mass: a PI controller of the force along z of O. The
/// end effector must touch a horizontal surface.
///
/// Parameters in the controller's namespace: `arm_id`, `joint_names` (seven). dynamic_reconfigure
/// at `dynamic_reconfigure_desired_mass_param_node`, beside the controllers, sets mass and gains.
class ForceExampleController
    : public controller_interface::MultiInterfaceController<
          franka_hw::FrankaModelInterface, hardware_interface::EffortJointInterface,
          franka_hw::FrankaStateInterface> {
 public:
  /// @returns false, after one sentence in the log, if a parameter is missing or wrong or the robot
  /// lacks a handle.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "ForceExampleController";

  struct Target {
    double mass{0.0};  ///< [kg]
    double k_p{0.0};
    double k_i{0.0};  ///< [1/s]
  };

  void massCallback(desired_mass_paramConfig& config);

  std::unique_ptr<franka_hw::FrankaModelHandle> model_handle_;
  std::unique_ptr<franka_hw::FrankaStateHandle> state_handle_;
  std::vector<hardware_interface::JointHandle> joint_handles_;

  Target target_;  // approached gradually, without jumps
  std::array<double, 7> tau_ext_initial_{};
  std::array<double, 7> integral_{};

  realtime_tools::RealtimeBuffer<Target> configured_;
  std::unique_ptr<dynamic_reconfigure::Server<desired_mass_paramConfig>> mass_server_;  // last
};

}  // namespace franka_example_controllers
