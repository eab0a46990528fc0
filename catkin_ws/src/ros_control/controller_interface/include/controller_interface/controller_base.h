// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <hardware_interface/interface_resources.h>
#include <hardware_interface/robot_hw.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <atomic>
#include <memory>
#include <vector>

namespace controller_interface {

/// Base of all controllers: the callbacks that a controller implements, and the requests by which
/// the controller manager changes its state. A request runs the callback first and then changes the
/// state. The control loop makes every request except initRequest. Real-time safe. Every controller
/// must implement its callbacks so. Any thread may call the is... queries.
class ControllerBase {
 public:
  ControllerBase() = default;
  virtual ~ControllerBase() = default;
  ControllerBase(const ControllerBase&) = delete;
  ControllerBase& operator=(const ControllerBase&) = delete;
  ControllerBase(ControllerBase&&) = delete;
  ControllerBase& operator=(ControllerBase&&) = delete;

  /// Called once before the first update, with the time of this cycle.
  virtual void starting(const ros::Time& /*time*/) {}

  /// Called in every cycle while running.
  /// @param time of this cycle @param period since the cycle before
  virtual void update(const ros::Time& time, const ros::Duration& period) = 0;

  /// Called once after the last update, with the time of this cycle.
  virtual void stopping(const ros::Time& /*time*/) {}

  /// Called in every cycle while the start waits for the robot, with the time of this cycle.
  virtual void waiting(const ros::Time& /*time*/) {}

  /// Called when the start is aborted, with the time of this cycle.
  virtual void aborting(const ros::Time& /*time*/) {}

  /// @name The state of the controller
  /// @{
  bool isInitialized() const { return state_ == ControllerState::INITIALIZED; }
  bool isRunning() const { return state_ == ControllerState::RUNNING; }
  bool isStopped() const { return state_ == ControllerState::STOPPED; }
  bool isWaiting() const { return state_ == ControllerState::WAITING; }
  bool isAborted() const { return state_ == ControllerState::ABORTED; }
  /// @}

  /// Updates the controller if it runs.
  void updateRequest(const ros::Time& time, const ros::Duration& period) {
    if (state_ == ControllerState::RUNNING) {
      update(time, period);
    }
  }

  /// The four requests below return false, after logging, for a controller that is not initialized.
  bool startRequest(const ros::Time& time) {
    if (!mayChangeState("start")) {
      return false;
    }
    starting(time);
    state_ = ControllerState::RUNNING;
    return true;
  }

  /// Stops the controller.
  bool stopRequest(const ros::Time& time) {
    if (!mayChangeState("stop")) {
      return false;
    }
    stopping(time);
    state_ = ControllerState::STOPPED;
    return true;
  }

  /// Lets the start of the controller wait.
  bool waitRequest(const ros::Time& time) {
    if (!mayChangeState("wait")) {
      return false;
    }
    waiting(time);
    state_ = ControllerState::WAITING;
    return true;
  }

  /// Aborts the start of the controller.
  bool abortRequest(const ros::Time& time) {
    if (!mayChangeState("abort")) {
      return false;
    }
    aborting(time);
    state_ = ControllerState::ABORTED;
    return true;
  }

  /// Resources by hardware interface.
  typedef std::vector<hardware_interface::InterfaceResources> ClaimedResources;

  /// Initializes a constructed controller, outside the control loop. Not real-time safe.
  /// @param robot_hw offers the interfaces @param root_nh of the controller manager
  /// @param controller_nh of the controller's own namespace
  /// @param[out] claimed_resources the controller's claims
  /// @returns false after logging the reason
  virtual bool initRequest(hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh,
                           ros::NodeHandle& controller_nh, ClaimedResources& claimed_resources) = 0;

  /// States of a controller.
  enum class ControllerState { CONSTRUCTED, INITIALIZED, RUNNING, STOPPED, WAITING, ABORTED };

  /// Atomic: written by the control loop (before that by initRequest), read by services as well.
  std::atomic<ControllerState> state_{ControllerState::CONSTRUCTED};

 private:
  bool mayChangeState(const char* verb) const {
    if (state_ == ControllerState::CONSTRUCTED) {
      ROS_FATAL("Failed to %s controller. It is not initialized.", verb);
      return false;
    }
    return true;
  }
};

typedef std::shared_ptr<ControllerBase> ControllerBaseSharedPtr;

}  // namespace controller_interface
