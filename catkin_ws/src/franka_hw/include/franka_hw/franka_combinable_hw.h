// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/simple_action_server.h>
#include <franka_hw/franka_hw.h>
#include <franka_hw/latest.h>
#include <franka_hw/services.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <ros/publisher.h>

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace franka_hw {

/// One of several arms that run under one controller manager, with torque control only.
///
/// Each arm has a thread of its own that talks to its robot; read() and write(), which belong to
/// the controllers' loop, exchange states and commands with it without waiting. An error on this
/// arm is published on `has_error` and ends its motion; error_recovery, or resetError(), clears it,
/// and the controllers are then reset.
class FrankaCombinableHW : public FrankaHW {
 public:
  FrankaCombinableHW() = default;
  /// Ends the arm's thread and with it the motion.
  ~FrankaCombinableHW() override;

  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;
  void initROSInterfaces(ros::NodeHandle& robot_hw_nh) override;

  void connect() override;
  bool disconnect() override;
  bool connected() override;

  /// Moves the robot until the controllers are stopped or an error is triggered. In the arm's
  /// thread.
  void control(const std::function<bool(const ros::Time&, const ros::Duration&)>& ros_callback =
                   [](const ros::Time&, const ros::Duration&) { return true; }) override;

  bool checkForConflict(const std::list<hardware_interface::ControllerInfo>& info) const override;

  void read(const ros::Time& time, const ros::Duration& period) override;
  void write(const ros::Time& time, const ros::Duration& period) override;
  void checkJointLimits() override;

  std::string getArmID() const noexcept;
  /// Ends the motion as if the robot had an error.
  void triggerError();
  /// Whether the robot stopped: by an error of its own, or because another arm has one.
  bool hasError() const noexcept;
  /// Whether it is this robot that has to recover.
  bool hasOwnError() const noexcept;
  /// Ends the motion while another arm has an error, and lets it go on, with the controllers
  /// started anew, when that has recovered. Real-time safe.
  void waitForOthers(bool waits);
  /// Clears the robot's errors and the one noted here. @throws franka::Exception when it refuses
  void resetError();
  /// Whether the controllers have to start anew, because an error was cleared.
  bool controllerNeedsReset() const noexcept;

 protected:
  void initRobot() override;
  bool setRunFunction(const ControlMode& requested_control_mode, bool limit_rate,
                      double cutoff_frequency, franka::ControllerMode internal_controller) override;

 private:
  using RecoveryServer = actionlib::SimpleActionServer<franka_msgs::ErrorRecoveryAction>;

  franka::Torques torqueCallback(const franka::RobotState& robot_state);
  void controlLoop();
  void watchIdleRobot();
  void moveRobot();
  void reportError(const std::string& what);
  void setError(bool has_error);
  void publishErrorState();
  void setupServicesAndActionServers();
  void withdraw();
  void recover();

  ros::NodeHandle robot_hw_nh_;
  ros::Publisher has_error_publisher_;
  std::mutex service_mutex_;  // for the two below
  std::unique_ptr<ServiceContainer> services_;
  std::unique_ptr<RecoveryServer> recovery_server_;

  Latest<franka::RobotState> states_;
  Latest<franka::Torques> torques_{franka::Torques(std::array<double, 7>{})};

  std::atomic_bool has_error_{false};
  std::atomic_bool waits_for_others_{false};
  std::atomic_bool error_changed_{false};  // and not yet published
  std::atomic_bool error_recovered_{false};
  std::atomic_bool controller_needs_reset_{false};
  std::atomic_bool ending_{false};
  std::atomic_bool connected_{false};
  std::thread control_loop_thread_;
};

}  // namespace franka_hw
