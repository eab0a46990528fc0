// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/simple_action_server.h>
#include <combined_robot_hw/combined_robot_hw.h>
#include <franka_hw/franka_combinable_hw.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <ros/service_server.h>

#include <memory>
#include <vector>

namespace franka_hw {

/// Several FrankaCombinableHW as one robot. An error on one arm stops all of them; error_recovery
/// in this one's namespace recovers all, the arms' own actions one.
class FrankaCombinedHW : public combined_robot_hw::CombinedRobotHW {
 public:
  FrankaCombinedHW() = default;
  ~FrankaCombinedHW() override = default;

  /// Loads the arms named in `robot_hardware` and offers error_recovery, connect and disconnect.
  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;

  /// Reads all arms, and passes the error of one on to the others.
  void read(const ros::Time& time, const ros::Duration& period) override;

  /// Whether the controllers have to start anew, because an error was cleared on some arm.
  bool controllerNeedsReset();
  bool hasError();
  /// Ends the motions of all arms as if each had an error; for errors of the controllers' own.
  void triggerError();
  /// What the actions error_recovery, of one arm or of all, do before they clear an error. To be
  /// set before the first.
  void beforeRecovery(const std::function<void()>& task);

  /// Connects the arms that are not connected, also where one of them fails.
  /// @throws franka::NetworkException that names each arm that failed, why, and those that did not
  void connect();
  /// @returns false, leaving all connected, while a controller commands one of them
  bool disconnect();

  /// The arms among the parts of the robot. They live as long as this.
  const std::vector<FrankaCombinableHW*>& arms() const noexcept { return arms_; }

 private:
  using RecoveryServer = actionlib::SimpleActionServer<franka_msgs::ErrorRecoveryAction>;

  void setupServices(ros::NodeHandle& robot_hw_nh);
  void recover();
  void handleError();
  bool anyOwnError() const;

  std::vector<FrankaCombinableHW*> arms_;  // of robot_hw_list_
  std::unique_ptr<RecoveryServer> recovery_server_;
  std::function<void()> before_recovery_;
  ros::ServiceServer connect_server_;
  ros::ServiceServer disconnect_server_;
  std::atomic_bool is_recovering_{false};
};

}  // namespace franka_hw
