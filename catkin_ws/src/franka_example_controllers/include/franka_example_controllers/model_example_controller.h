// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <franka_hw/trigger_rate.h>
#include <hardware_interface/robot_hw.h>
#include <realtime_tools/latest_value.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <ros/wall_timer.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace franka_example_controllers {

/// Shows how to use the model: logs mass, Coriolis and gravity, the pose and body Jacobian of joint
/// 4 and the zero Jacobian of the end effector once a second.
///
/// Parameter in the controller's namespace: `arm_id`. The loop only computes; a timer prints.
class ModelExampleController
    : public controller_interface::MultiInterfaceController<franka_hw::FrankaModelInterface,
                                                            franka_hw::FrankaStateInterface> {
 public:
  /// @returns false, after one sentence in the log, if arm_id or a handle is missing.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "ModelExampleController";
  static constexpr double kPrintPeriod = 0.1;  // [s] between checks for new results

  struct Answers {
    std::uint64_t number{0};
    std::array<double, 49> mass{};
    std::array<double, 7> coriolis{}, gravity{};
    std::array<double, 16> O_T_J4{};
    std::array<double, 42> J4_J{}, O_J_EE{};
  };

  void print();

  std::unique_ptr<franka_hw::FrankaStateHandle> state_handle_;
  std::unique_ptr<franka_hw::FrankaModelHandle> model_handle_;
  franka_hw::TriggerRate rate_{1.0, ros::Time(0.0)};
  Answers computed_;
  std::uint64_t printed_{0};
  realtime_tools::LatestValue<Answers> answers_;
  ros::WallTimer timer_;  // last, so that it ends before the data that it prints
};

}  // namespace franka_example_controllers
