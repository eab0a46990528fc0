// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_node.h"

#include <franka/exception.h>
#include <franka_hw/robot_access.h>
#include <ros/console.h>
#include <ros/init.h>
#include <std_msgs/Bool.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "commanding_controllers.h"
#include "flag.h"

namespace franka_control {

namespace {

const ros::WallDuration kAtOnce(0.001);  // a timer of zero is none

}  // namespace

ControlNode::ControlNode(const ros::NodeHandle& public_nh, const ros::NodeHandle& private_nh)
    : public_nh_(public_nh), private_nh_(private_nh) {}

bool ControlNode::init() {
  if (!reconnection_.init(private_nh_) ||
      !readFlag("restart_controllers_after_recovery", private_nh_, restarts_controllers_) ||
      !franka_hw_.init(public_nh_, private_nh_)) {
    ROS_ERROR("franka_control_node: the robot could not be set up (see above).");
    return false;
  }
  connected_ = true;
  private_nh_.getParam("arm_id", arm_id_);
  robot_state_ = &franka_hw_.get<franka_hw::FrankaStateInterface>()
                      ->getHandle(arm_id_ + "_robot")
                      .getRobotState();
  aborts_ = std::make_unique<franka_hw::AbortReporter>(private_nh_, arm_id_);
  robot_health_ =
      std::make_unique<RobotHealth>(private_nh_, "Robot", arm_id_, franka_hw_.responseTimes());
  robot_health_->connected(true);
  loop_health_ = std::make_unique<LoopHealth>(private_nh_, arm_id_);
  has_error_publisher_ = private_nh_.advertise<std_msgs::Bool>("has_error", 1, true);
  setError(false);
  controller_manager_ =
      std::make_unique<controller_manager::ControllerManager>(&franka_hw_, public_nh_);
  offerConnection();
  offerRobot();
  ROS_INFO_STREAM("franka_control_node: the robot '" << arm_id_ << "' is ready.");
  return true;
}

// --- services ------------------------------------------------------------------------------------

void ControlNode::offerConnection() {
  connect_server_ = private_nh_.advertiseService("connect", &ControlNode::connectRequested, this);
  disconnect_server_ =
      private_nh_.advertiseService("disconnect", &ControlNode::disconnectRequested, this);
}

void ControlNode::offerRobot() {
  robot_services_ = std::make_unique<franka_hw::ServiceContainer>();
  franka_hw::setupServices(franka_hw_.robot(), franka_hw_.robotMutex(), private_nh_,
                           *robot_services_);
  recovery_server_ = std::make_unique<RecoveryServer>(
      private_nh_, "error_recovery", [this](const auto& /*goal*/) { recover(); }, false);
  recovery_server_->start();
}

void ControlNode::withdrawRobot() {
  if (recovery_server_) {
    // A recovery under way still answers through this pointer: it ends before reset() clears it.
    recovery_server_->shutdown();
  }
  recovery_server_.reset();
  robot_services_.reset();
}

bool ControlNode::connectRequested(TriggerRequest& /*request*/, TriggerResponse& response) {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  if (connected_) {
    response.success = false;
    response.message = "Already connected to robot. Cannot connect twice.";
    return true;
  }
  try {
    connectRobot();
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = std::string("Failed to connect robot: ") + error.what();
    ROS_ERROR_STREAM("franka_control_node: " << response.message);
  }
  return true;
}

void ControlNode::connectRobot() {
  withdrawRobot();
  franka_hw_.connect();
  {
    const std::lock_guard<std::mutex> lock(franka_hw_.robotMutex());
    franka_hw_.update(franka_hw_.robot().readOnce());
  }
  offerRobot();
  lost_ = false;
  connected_ = true;
  robot_health_->connected(true);
  ROS_INFO("franka_control_node: connected to the robot.");
}

bool ControlNode::disconnectRequested(TriggerRequest& /*request*/, TriggerResponse& response) {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  if (franka_hw_.controllerActive()) {
    response.success = false;
    response.message = "Controller is active. Cannot disconnect while a controller is running.";
    return true;
  }
  connected_ = false;
  withdrawRobot();
  response.success = franka_hw_.disconnect();
  response.message = response.success ? "" : "Failed to disconnect robot.";
  robot_health_->connected(false);
  lost_ = false;
  return true;
}

bool ControlNode::needsRecovery() const { return has_error_ || franka_hw_.robotStopped(); }

void ControlNode::recover() {
  try {
    if (!restarts_controllers_ && needsRecovery()) {
      stopCommandingControllers(public_nh_);
    }
    const auto lock = franka_hw::RobotAccessRequest::takeWhile(franka_hw_.robotMutex(),
                                                               [this] { return needsRecovery(); });
    if (!lock) {
      // The robot is not touched: a recovery ahead of time must not clear an error still to come.
      ROS_WARN("franka_control_node: error_recovery was called, but there is nothing to recover.");
      recovery_server_->setSucceeded();
      return;
    }
    ROS_INFO("franka_control_node: recovering from the error.");
    // An error of the controllers' own (NaN, a lost connection) leaves the robot Idle.
    if (franka_hw_.robot().readOnce().robot_mode != franka::RobotMode::kIdle) {
      franka_hw_.robot().automaticErrorRecovery();
    }
    setError(false);
    recovery_server_->setSucceeded();
    ROS_INFO("franka_control_node: recovered from the error.");
  } catch (const std::exception& error) {
    std::string reason = error.what();
    if (franka_hw_.robotMode() == franka::RobotMode::kUserStopped) {
      reason += " The user stop is pressed: release it, and the robot goes on by itself.";
    }
    ROS_ERROR_STREAM("franka_control_node: the robot did not recover. " << reason);
    recovery_server_->setAborted(franka_msgs::ErrorRecoveryResult(), reason);
  }
}

// --- the loop ------------------------------------------------------------------------------------

void ControlNode::run() {
  last_update_ = franka_hw_.stateTime();
  while (ros::ok()) {
    if (!connected_) {
      if (lost_) {
        reconnection_.attempt(arm_id_, [this] {
          const std::lock_guard<std::mutex> lock(connection_mutex_);
          connectRobot();
        });
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } else if (franka_hw_.controllerActive() && !has_error_) {
      moveRobot();
    } else {
      watchIdleRobot();
    }
  }
}

void ControlNode::watchIdleRobot() {
  try {
    readIdleRobot();
  } catch (const franka::Exception& error) {
    robotLost(error.what());
    return;
  }
  const ros::Time now = franka_hw_.stateTime();
  try {
    updateControllers(now, now - last_update_, false);
  } catch (const std::exception& error) {
    controllerThrew(error.what());
  }
  franka_hw_.checkJointLimits();
  last_update_ = now;
  if (has_error_ && robot_stopped_ && franka_hw_.robotMode() == franka::RobotMode::kIdle) {
    recoveredByOthers();
  }
  franka_hw::RobotAccessRequest::giveWay();
}

void ControlNode::controllerThrew(const std::string& what) {
  thrown_report_.report("franka_control_node", what,
                        "The robot is not moved until the controller has been stopped "
                        "(controller_manager/switch_controller) and error_recovery called.");
  robot_stopped_ = false;  // the error does not end because the robot is Idle
  if (!has_error_) {
    interrupted_ = true;
    setError(true);
  }
}

void ControlNode::recoveredByOthers() {
  // Somebody else recovered the robot, or released the user stop.
  if (restarts_controllers_ || !franka_hw_.controllerActive()) {
    setError(false);
  } else if (!stopping_controllers_.exchange(true)) {
    // Stopping waits for this loop.
    stop_timer_ = public_nh_.createWallTimer(
        kAtOnce,
        [this](const ros::WallTimerEvent&) {
          stopCommandingControllers(public_nh_);
          stopping_controllers_ = false;
        },
        true);
  }
}

void ControlNode::readIdleRobot() {
  const std::lock_guard<std::mutex> lock(franka_hw_.robotMutex());
  if (!franka_hw_.connected()) {
    return;
  }
  const franka::RobotState state = franka_hw_.readPatiently();
  franka_hw_.update(state);
  robot_health_->state(state);
}

void ControlNode::moveRobot() {
  try {
    franka_hw_.control([this](const ros::Time& time, const ros::Duration& period) {
      return updateMoving(time, period);
    });
  } catch (const franka::ControlException& error) {
    motionFailed(error.what(), error.log);
    robot_stopped_ = true;
  } catch (const franka::NetworkException& error) {
    aborts_->report(error.what(), {});
    robotLost(error.what());
  } catch (const std::exception& error) {
    motionFailed(error.what(), {});
    robot_stopped_ = false;
  }
  last_update_ = franka_hw_.stateTime();
}

bool ControlNode::updateMoving(const ros::Time& time, const ros::Duration& period) {
  const bool first = period.isZero();
  robot_health_->state(*robot_state_);
  // After an interruption the controllers start anew from where the robot stands. Those that a
  // switch has just started must not: they may have got a goal already.
  const bool anew = first && (interrupted_ || franka_hw_.motionGoesOn());
  if (first) {
    interrupted_ = false;
  }
  updateControllers(time, period, anew);
  franka_hw_.checkJointLimits();
  if (first) {
    franka_hw_.reset();
  } else {
    franka_hw_.enforceLimits(period);
  }
  return ros::ok();
}

void ControlNode::updateControllers(const ros::Time& time, const ros::Duration& period,
                                    bool reset) {
  loop_health_->cycleBegins();
  try {
    controller_manager_->update(time, period, reset);
  } catch (const std::exception&) {
    throw;
  } catch (...) {
    throw std::runtime_error("something that is no std::exception.");
  }
  loop_health_->cycleEnds();
}

void ControlNode::motionFailed(const std::string& what, const std::vector<franka::Record>& log) {
  interrupted_ = true;
  setError(true);
  aborts_->report(what, log);
}

void ControlNode::setError(bool has_error) {
  has_error_ = has_error;
  robot_health_->hasError(has_error);
  std_msgs::Bool message;
  message.data = has_error;
  has_error_publisher_.publish(message);
}

void ControlNode::robotLost(const std::string& what) {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  ROS_ERROR_STREAM("franka_control_node: " << reconnection_.report(what));
  connected_ = false;
  lost_ = true;
  // What ran when it was lost must not move it when it is back, unless somebody says so.
  robot_stopped_ = false;
  interrupted_ = true;
  robot_health_->connected(false);
  setError(franka_hw_.controllerActive() || has_error_);
  withdrawRobot();
  franka_hw_.dropConnection();
}

}  // namespace franka_control
