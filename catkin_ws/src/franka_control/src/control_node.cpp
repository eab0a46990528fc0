// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_node.h"

#include <ros/console.h>
#include <ros/init.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "commanding_controllers.h"
#include "flag.h"

namespace franka_control {

namespace {

// A timer with period zero would never fire.
const ros::WallDuration kMinTimerPeriod(0.001);

}  // namespace

ControlNode::ControlNode(const ros::NodeHandle& public_nh, const ros::NodeHandle& private_nh)
    : public_nh_(public_nh), private_nh_(private_nh) {}

bool ControlNode::init() {
  if (!connection_.init(private_nh_) ||
      !readFlag("restart_controllers_after_recovery", private_nh_, restarts_controllers_) ||
      !franka_hw_.init(public_nh_, private_nh_)) {
    ROS_ERROR("franka_control_node: the robot could not be set up (see above).");
    return false;
  }
  std::string arm_id;
  private_nh_.getParam("arm_id", arm_id);
  robot_state_ = &franka_hw_.get<franka_hw::FrankaStateInterface>()
                      ->getHandle(arm_id + "_robot")
                      .getRobotState();
  robot_health_ = std::make_unique<RobotHealth>(private_nh_, "Robot", arm_id, connection_,
                                                franka_hw_.responseTimes());
  loop_health_ = std::make_unique<LoopHealth>(private_nh_, arm_id);
  controller_manager_ =
      std::make_unique<controller_manager::ControllerManager>(&franka_hw_, public_nh_);
  if (!restarts_controllers_) {
    connection_.beforeRecovery([this] { stopCommandingControllers(public_nh_); });
  }
  connection_.offer(private_nh_, arm_id);
  ROS_INFO_STREAM("franka_control_node: the robot '" << arm_id << "' is ready.");
  return true;
}

void ControlNode::run() {
  last_update_ = franka_hw_.stateTime();
  while (ros::ok()) {
    connection_.publishError();
    if (!connection_.connected()) {
      connection_.reconnect();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    } else if (franka_hw_.controllerActive() && !connection_.hasError() && !ros::isShuttingDown()) {
      moveRobot();
    } else {
      watchIdleRobot();
    }
  }
}

void ControlNode::watchIdleRobot() {
  franka::RobotState state;
  if (!connection_.readAtRest(state)) {
    interrupted_ = interrupted_ || isLost(connection_.state());
    return;
  }
  franka_hw_.update(state);
  robot_health_->state(state);
  const ros::Time now = franka_hw_.stateTime();
  try {
    updateControllers(now, now - last_update_, false);
  } catch (const std::exception& error) {
    controllerThrew(error.what());
  }
  franka_hw_.checkJointLimits();
  last_update_ = now;
  if (connection_.state() == franka_hw::ArmState::kStopped &&
      state.robot_mode == franka::RobotMode::kIdle) {
    recoveredByOthers();
  }
  connection_.mutex().yieldToRequests();
}

void ControlNode::controllerThrew(const std::string& what) {
  thrown_report_.report("franka_control_node", what,
                        "The robot is not moved until the controller has been stopped "
                        "(controller_manager/switch_controller) and error_recovery called.");
  interrupted_ = interrupted_ || !connection_.hasError();
  connection_.fail();
}

void ControlNode::recoveredByOthers() {
  // The robot was recovered by another client, or its user stop was released.
  if (restarts_controllers_ || !franka_hw_.controllerActive()) {
    connection_.recoveredElsewhere();
  } else if (!stopping_controllers_.exchange(true)) {
    // Called by a timer, because stopping controllers waits for this loop.
    stop_timer_ = public_nh_.createWallTimer(
        kMinTimerPeriod,
        [this](const ros::WallTimerEvent&) {
          stopCommandingControllers(public_nh_);
          stopping_controllers_ = false;
        },
        true);
  }
}

void ControlNode::moveRobot() {
  const bool in_order = connection_.move([this] {
    franka_hw_.control([this](const ros::Time& time, const ros::Duration& period) {
      return updateMoving(time, period);
    });
  });
  interrupted_ = interrupted_ || !in_order;
  last_update_ = franka_hw_.stateTime();
}

bool ControlNode::updateMoving(const ros::Time& time, const ros::Duration& period) {
  const bool first = period.isZero();
  robot_health_->state(*robot_state_);
  // After an interruption the controllers are restarted at the robot's present position.
  // Controllers that a switch has just started must not be restarted: they may already have a goal.
  const bool restart = first && (interrupted_ || franka_hw_.motionGoesOn());
  if (first) {
    interrupted_ = false;
  }
  updateControllers(time, period, restart);
  franka_hw_.checkJointLimits();
  if (first) {
    franka_hw_.reset();
  } else {
    franka_hw_.enforceLimits(period);
  }
  // The motion ends at the begin of a shutdown: ros::ok() is true until every topic and service is
  // unregistered. Meanwhile run() goes on, as a service may wait for an update of the controllers.
  return !ros::isShuttingDown();
}

void ControlNode::updateControllers(const ros::Time& time, const ros::Duration& period,
                                    bool reset) {
  loop_health_->cycleBegins();
  try {
    controller_manager_->update(time, period, reset);
  } catch (const std::exception&) {
    throw;
  } catch (...) {
    throw std::runtime_error("a value that is not a std::exception.");
  }
  loop_health_->cycleEnds();
}

}  // namespace franka_control
