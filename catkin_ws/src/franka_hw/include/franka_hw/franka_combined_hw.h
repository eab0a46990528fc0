// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <combined_robot_hw/combined_robot_hw.h>
#include <franka_hw/franka_combinable_hw.h>
#include <franka_hw/goal_server.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <ros/service_server.h>

#include <functional>
#include <list>
#include <memory>
#include <vector>

namespace franka_hw {

/// Several FrankaCombinableHW as one robot. An error of one arm stops all of them, until no arm has
/// an error. The action error_recovery in the namespace of this robot recovers all arms; each arm's
/// own action recovers that arm.
///
/// read() decides once per cycle whether the arms may move and whether the controllers have to be
/// reset, so that the two agree for the whole cycle: the first commands after an error are those of
/// controllers that have been reset. The states are read in every cycle.
class FrankaCombinedHW : public combined_robot_hw::CombinedRobotHW {
 public:
  FrankaCombinedHW() = default;
  ~FrankaCombinedHW() override = default;

  /// Loads the arms named in `robot_hardware` and offers error_recovery, connect and disconnect.
  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;

  /// Reads all arms, and stops the others if one has an error.
  void read(const ros::Time& time, const ros::Duration& period) override;
  /// Passes the commands to all arms; does nothing in a cycle that begins with an error of an arm.
  void write(const ros::Time& time, const ros::Duration& period) override;

  /// As CombinedRobotHW. Asks all arms before it prepares one of them, because a preparation may
  /// end a motion: a refused switch leaves the motions of all arms as they are.
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) override;

  /// Whether the controllers have to be reset in this cycle: the first one without an error of any
  /// arm after one was cleared.
  bool controllerNeedsReset();
  /// Whether an arm has an error now.
  bool hasError();
  /// Ends the motions of all arms as if each had an error. Used for errors of controllers.
  void triggerError();
  /// Sets what a recovery, of one arm or of all, does before it clears an error
  /// (ArmConnection::beforeRecovery). Call it before the first recovery.
  void beforeRecovery(const std::function<void()>& task);

  /// Connects the arms that are not connected, even if one of them fails.
  /// @throws franka::NetworkException that names each arm that failed, the reasons, and the other
  /// arms
  void connect();
  /// @returns false, and leaves all connected, while a controller commands one of them
  bool disconnect();

  /// The arms of this robot. They live as long as this object.
  const std::vector<FrankaCombinableHW*>& arms() const noexcept { return arms_; }

 private:
  using RecoveryServer = GoalServer<franka_msgs::ErrorRecoveryAction>;

  void setupServices(ros::NodeHandle& robot_hw_nh);
  void recover();
  void stopOthers();

  std::vector<FrankaCombinableHW*> arms_;  // owned by robot_hw_list_
  std::unique_ptr<RecoveryServer> recovery_server_;
  ros::ServiceServer connect_server_;
  ros::ServiceServer disconnect_server_;
  // Of the controllers' loop: in this cycle.
  bool stopped_{false};      // it began with an error of an arm
  bool reset_due_{false};    // an error was cleared, but the controllers were not reset since
  bool needs_reset_{false};  // the controllers have to be reset
};

}  // namespace franka_hw
