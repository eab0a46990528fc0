// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/multi_interface_controller.h>
#include <franka_hw/franka_state_interface.h>
#include <franka_hw/trigger_rate.h>
#include <geometry_msgs/WrenchStamped.h>
#include <realtime_tools/realtime_publisher.h>
#include <ros/node_handle.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace franka_control {

class StatePublisher;

/// Publishes the state of one arm. Commands nothing, so it may run together with any other
/// controller.
///
/// Parameters in the controller's namespace: `arm_id`, `joint_names` (seven) and `publish_rate`
/// [Hz] (30). Topics in this namespace: `franka_states` (the complete state), `joint_states` (q,
/// dq, tau_J), `joint_states_desired` (q_d, dq_d, tau_J_d) and `F_ext` (K_F_ext_hat_K, in
/// `<arm_id>_K`). Also publishes `/tf` from `<arm_id>_link8` over `_NE` and `_EE` to `_K`. Stamps
/// are the time argument of update().
///
/// The control loop calls update(). Real-time safe. Exception: init(). Up to 64 complete states are
/// queued if the publishing thread is late; each other message is dropped if the previous one has
/// not been sent yet.
class FrankaStateController
    : public controller_interface::MultiInterfaceController<franka_hw::FrankaStateInterface> {
 public:
  FrankaStateController();
  ~FrankaStateController() override;

  /// @returns false, after one sentence in the log, if a parameter is missing or wrong or the robot
  /// has no state handle `<arm_id>_robot`.
  bool init(hardware_interface::RobotHW* robot_hardware, ros::NodeHandle& root_node_handle,
            ros::NodeHandle& controller_node_handle) override;

  /// Begins the first period; the first messages are sent at its end.
  void starting(const ros::Time& time) override;

  void update(const ros::Time& time, const ros::Duration& period) override;

 private:
  template <typename Message>
  using Publisher = std::unique_ptr<realtime_tools::RealtimePublisher<Message>>;

  bool readParameters(const ros::NodeHandle& controller_node_handle);
  bool takeHandle(hardware_interface::RobotHW* robot_hardware);
  void createPublishers(const ros::NodeHandle& root_node_handle,
                        const ros::NodeHandle& controller_node_handle);
  void publishFrankaState(const ros::Time& time);
  void publishTransforms(const ros::Time& time);
  void publishExternalWrench(const ros::Time& time);
  void publishJointStates(const ros::Time& time);

  std::string arm_id_;
  std::vector<std::string> joint_names_;
  std::unique_ptr<franka_hw::FrankaStateHandle> state_handle_;
  double publish_rate_{30.0};  ///< [Hz]
  franka_hw::TriggerRate trigger_{publish_rate_, ros::Time()};
  std::uint32_t sequence_number_{0};

  std::unique_ptr<StatePublisher> franka_state_publisher_;
  Publisher<tf2_msgs::TFMessage> transforms_publisher_;
  Publisher<geometry_msgs::WrenchStamped> external_wrench_publisher_;
  Publisher<sensor_msgs::JointState> joint_states_publisher_;
  Publisher<sensor_msgs::JointState> joint_states_desired_publisher_;
};

}  // namespace franka_control
