// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <actionlib/server/simple_action_server.h>
#include <franka_hw/abort_reporter.h>
#include <franka_hw/franka_hw.h>
#include <franka_hw/latest.h>
#include <franka_hw/reconnection.h>
#include <franka_hw/services.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <ros/publisher.h>
#include <ros/service_server.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace franka_hw {

/// One of several arms that run under one controller manager, with torque control only.
///
/// Each arm has a thread of its own that talks to its robot; read() and write(), which belong to
/// the controllers' loop, exchange states and commands with it without waiting. An error on this
/// arm is published on `has_error` and ends its motion; error_recovery, or resetError(), clears it,
/// and the controllers are then reset.
///
/// A robot that is lost is such an error, too. The services `connect` and `disconnect` in the arm's
/// namespace take it again, or give it up, so that the others need not wait for it any more;
/// with the parameter `reconnect` the arm's thread connects by itself.
class FrankaCombinableHW : public FrankaHW {
 public:
  FrankaCombinableHW() = default;
  /// Ends the arm's thread and with it the motion.
  ~FrankaCombinableHW() override;

  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override;
  void initROSInterfaces(ros::NodeHandle& robot_hw_nh) override;

  void connect() override;
  /// Also of an arm that is lost: its error is then no longer one.
  bool disconnect() override;

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
  /// Clears the robot's errors and the one noted here. A robot that is Idle has none. Where nothing
  /// needs it, only a warning is logged.
  /// @throws franka::Exception when it refuses or is not connected
  void resetError();
  /// Whether an error is noted here, or the robot was stopped while no controller moved it.
  bool needsRecovery() const noexcept;
  /// What the action error_recovery does before it clears an error. To be set before the first.
  void beforeRecovery(std::function<void()> task);
  /// Whether the controllers have to start anew, because an error was cleared.
  bool controllerNeedsReset() const noexcept;

 protected:
  void initRobot() override;
  bool setRunFunction(const ControlMode& requested_control_mode, bool limit_rate,
                      double cutoff_frequency, franka::ControllerMode internal_controller) override;

 private:
  using RecoveryServer = actionlib::SimpleActionServer<franka_msgs::ErrorRecoveryAction>;

  typedef std_srvs::Trigger::Request TriggerRequest;
  typedef std_srvs::Trigger::Response TriggerResponse;

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
  void readIdleRobot();
  void moveRobot();
  void abort(const std::string& what, const std::vector<franka::Record>& log);
  void lose(const std::string& what);
  void setError(bool has_error);
  void publishErrorState();
  void offerConnection();
  bool connectRequested(TriggerRequest& request, TriggerResponse& response);
  bool disconnectRequested(TriggerRequest& request, TriggerResponse& response);
  void offerRobot();
  void withdrawRobot();
  void recover();

  ros::NodeHandle robot_hw_nh_;
  ros::Publisher has_error_publisher_;
  std::unique_ptr<AbortReporter> aborts_;
  ros::ServiceServer connect_server_, disconnect_server_;
  std::mutex connection_mutex_;  // one at a time connects, disconnects or notices the loss
  std::unique_ptr<ServiceContainer> services_;
  std::unique_ptr<RecoveryServer> recovery_server_;
  std::function<void()> before_recovery_;
  Reconnection reconnection_;  // of the arm's thread

  Latest<ArrivedState> states_;
  Latest<Answer> answers_;
  ResponseTimes::Clock::time_point read_arrival_{};  // of the state that the controllers see
  ResponseTimes::Clock::time_point motion_ended_{};  // of the arm's thread

  std::atomic_bool has_error_{false};
  std::atomic_bool waits_for_others_{false};
  std::atomic_bool error_changed_{false};  // and not yet published
  std::atomic_bool error_recovered_{false};
  std::atomic_bool controller_needs_reset_{false};
  std::atomic_bool lost_{false};  // the connection, without being asked to
  std::atomic_bool ending_{false};
  std::thread control_loop_thread_;
};

}  // namespace franka_hw
