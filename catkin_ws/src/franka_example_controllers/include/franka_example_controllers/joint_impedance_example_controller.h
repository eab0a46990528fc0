// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <franka_example_controllers/JointTorqueComparison.h>
#include <franka_example_controllers/pi.h>
#include <franka_hw/franka_cartesian_command_interface.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/trigger_rate.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// Moves the end effector along a circle by its pose, and follows with its own joint impedance:
/// torques and a motion generator together.
///
/// Parameters in the controller's namespace: `arm_id`, `joint_names`, `k_gains` [Nm/rad] and
/// `d_gains` [Nm s/rad] (seven each); `radius` of the circle [m], `vel_max` along it [m/s],
/// `acceleration_time` to reach it [s], `coriolis_factor`, and `publish_rate` [Hz] of the topic
/// `torque_comparison` (JointTorqueComparison) in the same namespace.
class JointImpedanceExampleController
    : public controller_interface::MultiInterfaceController<
          franka_hw::FrankaModelInterface, hardware_interface::EffortJointInterface,
          franka_hw::FrankaPoseCartesianInterface> {
 public:
  /// @returns false, after one sentence in the log, if a parameter is missing or wrong or the robot
  /// lacks a handle.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "JointImpedanceExampleController";
  static constexpr double kTwoPi = 2.0 * kPi;
  static constexpr double kMinRadius = 0.005;  // [m]
  // Share of the new velocity in the filtered one; the original's constant.
  static constexpr double kVelocityShare = 0.99;

  bool readParameters(const ros::NodeHandle& node_handle);
  void leadAlongCircle(double dt);
  std::array<double, 7> torques();
  void compare(const franka::RobotState& state, const ros::Time& time);

  std::unique_ptr<franka_hw::FrankaCartesianPoseHandle> pose_handle_;
  std::unique_ptr<franka_hw::FrankaModelHandle> model_handle_;
  std::vector<hardware_interface::JointHandle> joint_handles_;

  double radius_{0.1};
  double acceleration_time_{2.0};
  double vel_max_{0.05};
  double coriolis_factor_{1.0};
  std::vector<double> k_gains_, d_gains_;

  double angle_{0.0};     // on the circle [rad]
  double velocity_{0.0};  // along it [m/s]
  std::array<double, 16> O_T_EE_start_{};
  std::array<double, 7> dq_filtered_{};
  std::array<double, 7> last_tau_{};  // command of the last cycle [Nm]

  franka_hw::TriggerRate rate_{30.0, ros::Time(0.0)};
  double publish_rate_{30.0};
  realtime_tools::RealtimePublisher<JointTorqueComparison> publisher_;
};

}  // namespace franka_example_controllers
