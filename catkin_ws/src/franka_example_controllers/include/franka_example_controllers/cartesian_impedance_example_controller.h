// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <dynamic_reconfigure/server.h>
#include <franka_example_controllers/cartesian_impedance.h>
#include <franka_example_controllers/compliance_paramConfig.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <geometry_msgs/PoseStamped.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <realtime_tools/realtime_buffer.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// Pulls the end effector to an equilibrium pose by virtual springs and dampers.
///
/// Parameters in the controller's namespace: `arm_id`, `joint_names` (seven). Topic in the same
/// namespace: `equilibrium_pose` (geometry_msgs/PoseStamped, in O; the frame id is ignored).
/// dynamic_reconfigure at `dynamic_reconfigure_compliance_param_node` there sets the stiffness.
///
/// The control loop calls starting() and update(); poses and stiffness come from other threads
/// through real-time buffers. Real-time safe. Exception: init(). Each start begins at the arm's
/// present pose: earlier equilibrium poses are dropped.
class CartesianImpedanceExampleController
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
  static constexpr char kName[] = "CartesianImpedanceExampleController";
  static constexpr double kMinQuaternionNorm =
      1e-3;                                  ///< below it a quaternion is not a valid rotation
  static constexpr double kLogPeriod = 1.0;  ///< [s] between log messages about invalid input

  struct Equilibrium {
    Eigen::Vector3d position{Eigen::Vector3d::Zero()};
    Eigen::Quaterniond orientation{Eigen::Quaterniond::Identity()};
    std::uint64_t number{0};  ///< counts the received poses, to detect a new one
  };

  bool takeHandles(hardware_interface::RobotHW* robot_hw, const std::string& arm_id,
                   const std::vector<std::string>& joint_names);
  void equilibriumPoseCallback(const geometry_msgs::PoseStampedConstPtr& message);
  void complianceCallback(compliance_paramConfig& config);

  std::unique_ptr<franka_hw::FrankaStateHandle> state_handle_;
  std::unique_ptr<franka_hw::FrankaModelHandle> model_handle_;
  std::vector<hardware_interface::JointHandle> joint_handles_;

  CartesianImpedance impedance_;
  std::uint64_t equilibrium_in_use_{0};

  std::uint64_t equilibria_received_{0};
  compliance_paramConfig accepted_compliance_;
  realtime_tools::RealtimeBuffer<Equilibrium> equilibrium_;
  realtime_tools::RealtimeBuffer<Compliance> compliance_;
  // Last, so that their callbacks end before the members that they use.
  std::unique_ptr<dynamic_reconfigure::Server<compliance_paramConfig>> compliance_server_;
  ros::Subscriber equilibrium_subscriber_;
};

}  // namespace franka_example_controllers
