// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/franka_hw.h>
#include <realtime_tools/latest_value.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <list>
#include <string>
#include <thread>

namespace franka_hw {

/// One of several arms that run under one controller manager, with torque control only.
///
/// Each arm has a thread of its own that communicates with its robot. read() and write(), called by
/// the thread of the controllers' loop, exchange states and commands with it without waiting. The
/// latest torques answer the next states, too, but at most 20 of them: while the loop stalls for
/// longer, the robot gets no answer and ends the motion by itself, as that of one arm's node does.
/// An error of this arm is published on `has_error` and ends its motion; error_recovery, or
/// resetError(), clears it, and the controllers are then reset.
///
/// The loss of a robot is an error, too: the other arms wait until it recovers or is given up. The
/// services of the arm, its recovery and its reconnection: ArmConnection.
class FrankaCombinableHW : public FrankaHW {
 public:
  FrankaCombinableHW() = default;
  /// Ends the arm's thread and its motion.
  ~FrankaCombinableHW() override;

  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;
  void initROSInterfaces(ros::NodeHandle& robot_hw_nh) override;

  /// Moves the robot until the controllers are stopped or an error is triggered. Called by the
  /// arm's thread.
  void control(const std::function<bool(const ros::Time&, const ros::Duration&)>& ros_callback =
                   [](const ros::Time&, const ros::Duration&) { return true; }) override;

  bool checkForConflict(const std::list<hardware_interface::ControllerInfo>& info) const override;
  bool prepareSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) override;
  /// As FrankaHW. After init(), refuses to start controllers that command an arm without a
  /// connection. The original accepts them, and its arm's thread then ends the process.
  bool acceptsSwitch(const std::list<hardware_interface::ControllerInfo>& start_list,
                     const std::list<hardware_interface::ControllerInfo>& stop_list) const override;

  void read(const ros::Time& time, const ros::Duration& period) override;
  void write(const ros::Time& time, const ros::Duration& period) override;

  /// The prefix of the arm's joints and links.
  std::string getArmID() const noexcept;
  /// Ends the motion as if the robot had an error.
  void triggerError();
  /// Whether the robot has stopped because of its own error or because of another arm's.
  bool hasError() const noexcept;
  /// Ends the motion while another arm has an error. After that arm's recovery the motion continues
  /// and the controllers are reset. Real-time safe.
  void waitForOthers(bool waits);
  /// As ArmConnection::recover().
  void resetError();
  /// Whether the controllers have to be reset, because an error was cleared: true for one cycle,
  /// from the first read() without an error to the next one.
  bool controllerNeedsReset() const noexcept;

 protected:
  void initRobot() override;
  bool supports(ControlMode mode) const override;
  bool setRunFunction(const ControlMode& requested_control_mode, bool limit_rate,
                      double cutoff_frequency, franka::ControllerMode internal_controller) override;

 private:
  /// Torques, and the arrival time of the state from which they were computed.
  struct Answer {
    franka::Torques torques{std::array<double, 7>{}};
    ResponseTimes::Clock::time_point since{};
    std::uint64_t number{0};  ///< of the cycle of the controllers' loop
  };
  struct ArrivedState {
    franka::RobotState state{};
    ResponseTimes::Clock::time_point arrival{};
  };

  franka::Torques torqueCallback(const franka::RobotState& robot_state);
  bool mayMove() const noexcept;
  const Answer& awaitAnswer();
  void controlLoop();
  void watchRobot();
  bool lossIsError() const override { return true; }
  void errorEnds() override { error_recovered_ = true; }

  realtime_tools::LatestValue<ArrivedState> states_;
  realtime_tools::LatestValue<Answer> answers_;
  // Of the controllers' loop.
  ResponseTimes::Clock::time_point read_arrival_{};  // of the state that the controllers read
  std::uint64_t cycles_{0};
  // Of the arm's thread.
  ResponseTimes::Clock::time_point motion_ended_{};
  std::uint64_t last_number_{0};  // of the last answer
  int repetitions_{0};            // of it

  std::atomic_bool error_recovered_{false};
  std::atomic_bool controller_needs_reset_{false};
  std::atomic_bool ending_{false};
  std::thread control_loop_thread_;
};

}  // namespace franka_hw
