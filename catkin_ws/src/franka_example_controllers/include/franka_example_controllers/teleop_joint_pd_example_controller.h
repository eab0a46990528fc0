// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <dynamic_reconfigure/server.h>
#include <franka_example_controllers/joint_wall.h>
#include <franka_example_controllers/teleop_follow.h>
#include <franka_example_controllers/teleop_paramConfig.h>
#include <franka_hw/franka_state_interface.h>
#include <franka_hw/trigger_rate.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <realtime_tools/realtime_buffer.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64.h>
#include <visualization_msgs/MarkerArray.h>

#include <memory>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// Data of one arm.
struct FrankaDataContainer7 {
  std::string arm_id;                                          ///< prefix of its joints and links
  std::unique_ptr<franka_hw::FrankaStateHandle> state_handle;  ///< its state
  std::vector<hardware_interface::JointHandle> joint_handles;  ///< its joints, for torques
  std::unique_ptr<JointWallContainer<7>> walls;  ///< push joints back from their limits
};

/// Lets one arm follow another, with feedback of the follower's contacts to the leader.
///
/// Parameters in the controller's namespace: `leader/` and `follower/` with `arm_id`,
/// `joint_names`, the gains and limits of TeleopParameters and `contact_force_threshold`; `debug`
/// (bool). With debug, dynamic_reconfigure at `dyn_reconf_teleop_param_node` sets gains, and the
/// topics `leader_target`, `follower_target`, `leader_contact`, `follower_contact` and
/// `marker_labels` (60 Hz) show the state. Soft joint limits are read from `robot_description`
/// above the controller's namespace.
class TeleopJointPDExampleController
    : public controller_interface::MultiInterfaceController<
          hardware_interface::EffortJointInterface, franka_hw::FrankaStateInterface> {
 public:
  /// @returns false, after one sentence in the log, if a parameter is missing or wrong or the robot
  /// lacks a handle.
  bool init(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& node_handle) override;
  void starting(const ros::Time& time) override;
  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  static constexpr char kName[] = "TeleopJointPDExampleController";
  static constexpr double kPublishRate = 60.0;  // [Hz]

  bool readParameters(const ros::NodeHandle& node_handle);
  bool initArm(hardware_interface::RobotHW* robot_hw, const ros::NodeHandle& node_handle,
               FrankaDataContainer7& arm);
  bool buildWalls(const ros::NodeHandle& node_handle, const std::vector<std::string>& joint_names,
                  FrankaDataContainer7& arm);
  void offerReconfigure(const ros::NodeHandle& node_handle);
  void reconfigure(const teleop_paramConfig& config);
  static TeleopArm armOf(const FrankaDataContainer7& arm) noexcept;
  static void command(FrankaDataContainer7& arm, const Vector7d& tau);
  void publish(const ros::Time& time);

  FrankaDataContainer7 leader_, follower_;
  TeleopParameters parameters_;  // as read; the loop uses those in the buffer
  TeleopFollow follow_;
  realtime_tools::RealtimeBuffer<TeleopParameters> parameters_in_use_;

  struct Publishers {
    realtime_tools::RealtimePublisher<sensor_msgs::JointState> leader_target, follower_target;
    realtime_tools::RealtimePublisher<std_msgs::Float64> leader_contact, follower_contact;
    realtime_tools::RealtimePublisher<visualization_msgs::MarkerArray> marker_labels;
  };
  std::unique_ptr<Publishers> publishers_;  // with debug only
  franka_hw::TriggerRate rate_{60.0, ros::Time(0.0)};
  std::unique_ptr<dynamic_reconfigure::Server<teleop_paramConfig>> server_;  // last
};

}  // namespace franka_example_controllers
