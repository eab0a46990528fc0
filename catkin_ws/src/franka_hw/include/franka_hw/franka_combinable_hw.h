// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/franka_hw.h>
#include <franka_hw/latest.h>

#include <atomic>
#include <functional>
#include <list>
#include <string>
#include <thread>

namespace franka_hw {

/// One of several arms that run under one controller manager, with torque control only.
///
/// Each arm has a thread of its own that talks to its robot; read() and write(), which belong to
/// the controllers' loop, exchange states and commands with it without waiting. An error on this
/// arm is published on `has_error` and ends its motion; error_recovery, or resetError(), clears it,
/// and the controllers are then reset.
///
/// A robot that is lost is such an error, too, for the others wait for it until it is given up.
/// What the arm offers in its namespace and how it recovers and reconnects: ArmConnection.
class FrankaCombinableHW : public FrankaHW {
 public:
  FrankaCombinableHW() = default;
  /// Ends the arm's thread and with it the motion.
  ~FrankaCombinableHW() override;

  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;
  void initROSInterfaces(ros::NodeHandle& robot_hw_nh) override;

  /// Moves the robot until the controllers are stopped or an error is triggered. In the arm's
  /// thread.
  void control(const std::function<bool(const ros::Time&, const ros::Duration&)>& ros_callback =
                   [](const ros::Time&, const ros::Duration&) { return true; }) override;

  bool checkForConflict(const std::list<hardware_interface::ControllerInfo>& info) const override;
  /// As of FrankaHW; once init() is done, it refuses to start what commands an arm that is not
  /// connected. The original agrees, and its arm's thread then ends the process.
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) override;

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
  /// ArmConnection::recover().
  void resetError();
  /// ArmConnection::needsRecovery().
  bool needsRecovery() const noexcept;
  /// ArmConnection::beforeRecovery().
  void beforeRecovery(std::function<void()> task);
  /// Whether the controllers have to start anew, because an error was cleared.
  bool controllerNeedsReset() const noexcept;

 protected:
  void initRobot() override;
  bool setRunFunction(const ControlMode& requested_control_mode, bool limit_rate,
                      double cutoff_frequency, franka::ControllerMode internal_controller) override;

 private:
  /// Torques, and when the state arrived that they were computed from.
  struct Answer {
    franka::Torques torques{std::array<double, 7>{}};
    ResponseTimes::Clock::time_point since{};
  };
  struct ArrivedState {
    franka::RobotState state{};
    ResponseTimes::Clock::time_point arrival{};
  };

  franka::Torques torqueCallback(const franka::RobotState& robot_state);
  void controlLoop();
  void watchRobot();
  bool lossIsError() const override { return true; }
  void errorEnds() override { error_recovered_ = true; }

  Latest<ArrivedState> states_;
  Latest<Answer> answers_;
  ResponseTimes::Clock::time_point read_arrival_{};  // of the state that the controllers see
  ResponseTimes::Clock::time_point motion_ended_{};  // of the arm's thread

  std::atomic_bool error_recovered_{false};
  std::atomic_bool controller_needs_reset_{false};
  std::atomic_bool ending_{false};
  std::thread control_loop_thread_;
};

}  // namespace franka_hw
