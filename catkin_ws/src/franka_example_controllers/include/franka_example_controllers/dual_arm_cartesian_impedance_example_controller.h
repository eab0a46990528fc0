// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <dynamic_reconfigure/server.h>
#include <franka_example_controllers/cartesian_impedance.h>
#include <franka_example_controllers/dual_arm_compliance_paramConfig.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <franka_hw/trigger_rate.h>
#include <geometry_msgs/PoseStamped.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <realtime_tools/realtime_buffer.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// Data of one arm.
struct FrankaDataContainer {
  std::string arm_id;                                          ///< prefix of its joints and links
  std::unique_ptr<franka_hw::FrankaStateHandle> state_handle;  ///< its state
  std::unique_ptr<franka_hw::FrankaModelHandle> model_handle;  ///< its model
  std::vector<hardware_interface::JointHandle> joint_handles;  ///< its joints, for torques
  CartesianImpedance impedance{RotationError::kAxisAngle};     ///< its law
};

/// Pulls two end effectors to equilibrium poses that keep their relative pose: both follow a
/// centering frame C half way between them.
///
/// Parameters in the controller's namespace: `left/arm_id`, `left/joint_names` and the same for
/// `right`. Topics in the same namespace: `centering_frame_target_pose` (geometry_msgs/PoseStamped
/// in the left arm's link0) moves C, `centering_frame` (30 Hz, latched) shows its pose.
/// dynamic_reconfigure at `dynamic_reconfigure_compliance_param_node`, beside the controllers, sets
/// the stiffness. The relative pose of the arms is read from tf, once.
class DualArmCartesianImpedanceExampleController
    : public controller_interface::MultiInterfaceController<
          franka_hw::FrankaModelInterface, hardware_interface::EffortJointInterface,
          franka_hw::FrankaStateInterface> {
 public:
  /// Waits up to 4 s for tf. @returns false, after one sentence in the log, if a parameter is
  /// missing or wrong, the robot lacks a handle, or tf lacks one of the arms.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "DualArmCartesianImpedanceExampleController";
  static constexpr double kTransformTimeout = 4.0;  // [s]
  static constexpr double kPublishRate = 30.0;      // [Hz]
  static constexpr double kMinQuaternionNorm = 1e-3;

  typedef franka_combined_example_controllers::dual_arm_compliance_paramConfig Config;

  struct Target {
    Eigen::Affine3d Ol_T_C{Eigen::Affine3d::Identity()};
    std::uint64_t number{0};  ///< counts the received poses
  };
  struct Stiffness {
    Compliance left, right;
  };

  bool initArm(hardware_interface::RobotHW* robot_hw, const ros::NodeHandle& node_handle,
               FrankaDataContainer& arm);
  bool findArms();
  void targetCallback(const geometry_msgs::PoseStampedConstPtr& message);
  void complianceCallback(Config& config);
  void lead(const Eigen::Affine3d& Ol_T_C) noexcept;
  static void updateArm(FrankaDataContainer& arm);
  void publishCenteringFrame(const ros::Time& time);

  FrankaDataContainer left_, right_;
  Eigen::Affine3d Ol_T_Or_{Eigen::Affine3d::Identity()};
  Eigen::Affine3d EEr_T_EEl_{Eigen::Affine3d::Identity()};
  Eigen::Affine3d EEl_T_C_{Eigen::Affine3d::Identity()};

  std::uint64_t target_in_use_{0};
  std::uint64_t targets_received_{0};
  franka_hw::TriggerRate rate_{30.0, ros::Time(0.0)};
  realtime_tools::RealtimePublisher<geometry_msgs::PoseStamped> publisher_;
  realtime_tools::RealtimeBuffer<Target> target_;
  realtime_tools::RealtimeBuffer<Stiffness> stiffness_;
  // Last, so that their callbacks end before the members that they use.
  std::unique_ptr<dynamic_reconfigure::Server<Config>> compliance_server_;
  ros::Subscriber target_subscriber_;
};

}  // namespace franka_example_controllers
