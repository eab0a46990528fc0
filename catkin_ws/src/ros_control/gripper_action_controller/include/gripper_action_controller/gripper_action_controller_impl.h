// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gripper_action_controller/gripper_action_controller.h>
#include <ros/console.h>

#include <algorithm>
#include <boost/bind/bind.hpp>
#include <cmath>
#include <exception>
#include <thread>
#include <type_traits>
#include <vector>

namespace gripper_action_controller {

template <class HardwareInterface>
GripperActionController<HardwareInterface>::~GripperActionController() {
  callbacks_.stop();  // before the objects that they use
  try {
    const std::lock_guard<std::recursive_mutex> lock(mutex_);
    endGoal("The controller '" + name_ + "' was unloaded.");
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("The end of a goal of '" << name_ << "' cannot be reported. " << error.what());
  }
  action_server_.reset();
  delete order_;
}

template <class HardwareInterface>
bool GripperActionController<HardwareInterface>::readParameters(ros::NodeHandle& controller_nh) {
  if (!controller_nh.getParam("joint", joint_name_) || joint_name_.empty()) {
    ROS_ERROR_STREAM("Parameter '" << controller_nh.resolveName("joint")
                                   << "' is missing or no text: it names the gripper's joint.");
    return false;
  }
  const auto read = [&](const std::string& name, double& value) {
    controller_nh.param(name, value, value);
    if (!std::isfinite(value) || value < 0.0) {
      ROS_ERROR_STREAM("Parameter '" << controller_nh.resolveName(name) << "' is " << value
                                     << ", but has to be a number of at least 0.");
      return false;
    }
    return true;
  };
  if (!read("action_monitor_rate", action_monitor_rate_) ||
      !read("goal_tolerance", goal_tolerance_) || !read("max_effort", default_max_effort_) ||
      !read("stall_velocity_threshold", stall_velocity_threshold_) ||
      !read("stall_timeout", stall_timeout_)) {
    return false;
  }
  if (action_monitor_rate_ < 1e-3) {
    ROS_ERROR_STREAM("Parameter '" << controller_nh.resolveName("action_monitor_rate") << "' is "
                                   << action_monitor_rate_
                                   << " Hz: clients would never learn how their goals end.");
    return false;
  }
  return true;
}

template <class HardwareInterface>
bool GripperActionController<HardwareInterface>::initRequest(
    hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh, ros::NodeHandle& controller_nh,
    controller_interface::ControllerBase::ClaimedResources& claims) {
  if (!controller_interface::Controller<HardwareInterface>::initRequest(robot_hw, root_nh,
                                                                        controller_nh, claims)) {
    return false;
  }
  // Efforts are limited by the adapter.
  if (std::is_same<HardwareInterface, hardware_interface::PositionJointInterface>::value) {
    auto* const limits = robot_hw->get<hardware_interface::JointEffortLimitInterface>();
    const std::vector<std::string> names =
        limits != nullptr ? limits->getNames() : std::vector<std::string>();
    if (std::find(names.begin(), names.end(), joint_name_) != names.end()) {
      effort_limit_ = limits->getHandle(joint_name_);
      has_effort_limit_ = true;
    }
  }
  return true;
}

template <class HardwareInterface>
bool GripperActionController<HardwareInterface>::init(HardwareInterface* hw,
                                                      ros::NodeHandle& /*root_nh*/,
                                                      ros::NodeHandle& controller_nh) {
  const std::string place = controller_nh.getNamespace();
  name_ = place.substr(place.rfind('/') + 1);
  if (!readParameters(controller_nh)) {
    return false;
  }
  try {
    joint_ = hw->getHandle(joint_name_);
  } catch (const hardware_interface::HardwareInterfaceException& error) {
    ROS_ERROR_STREAM_NAMED(name_, "Could not find joint '" << joint_name_ << "' in '"
                                                           << this->getHardwareInterfaceType()
                                                           << "': " << error.what());
    return false;
  }
  if (!hw_iface_adapter_.init(joint_, controller_nh)) {
    return false;
  }
  ros::NodeHandle own = callbacks_.of(controller_nh);
  action_server_ = std::make_shared<ActionServer>(
      own, "gripper_cmd",
      boost::bind(&GripperActionController::goalCB, this, boost::placeholders::_1),
      boost::bind(&GripperActionController::cancelCB, this, boost::placeholders::_1), false);
  action_server_->start();
  monitor_timer_ = own.createWallTimer(ros::WallDuration(1.0 / action_monitor_rate_),
                                       &GripperActionController::monitor, this);
  callbacks_.start();
  return true;
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::starting(const ros::Time& time) {
  exchange_.giveBack(exchange_.take());
  exchange_.giveBack(order_);
  order_ = nullptr;
  computed_effort_ = 0.0;
  hold();
  hw_iface_adapter_.starting(time);
  publishSnapshot(false);
  session_.fetch_add(1);
  running_.store(true);
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::stopping(const ros::Time& time) {
  running_.store(false);
  session_.fetch_add(1);
  limitEffort(0.0);
  hw_iface_adapter_.stopping(time);
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::update(const ros::Time& time,
                                                        const ros::Duration& period) {
  takeOrder();
  const double error_position = commands_.position_ - joint_.getPosition();
  const double velocity = joint_.getVelocity();
  const bool still = std::abs(velocity) <= stall_velocity_threshold_;
  still_for_ = still ? still_for_ + period.toSec() : 0.0;
  checkGoal(error_position);
  limitEffort(commands_.max_effort_);
  computed_effort_ = hw_iface_adapter_.updateCommand(
      time, period, commands_.position_, 0.0, error_position, -velocity, commands_.max_effort_);
  publishSnapshot(still_for_ > stall_timeout_ && !(std::abs(error_position) < goal_tolerance_));
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::limitEffort(double max_effort) {
  if (has_effort_limit_) {
    effort_limit_.setMaxEffort(max_effort);
  }
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::takeOrder() {
  Order* const order = exchange_.take();
  if (order == nullptr) {
    return;
  }
  if (order->session != session_.load(std::memory_order_relaxed)) {
    exchange_.giveBack(order);
    return;
  }
  exchange_.giveBack(order_);
  order_ = order;
  still_for_ = 0.0;
  if (order->goal) {
    commands_ = order->commands;
  } else {
    hold();
  }
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::hold() {
  commands_ = Commands{joint_.getPosition(), default_max_effort_};
  still_for_ = 0.0;
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::checkGoal(double error_position) {
  RealtimeGoal* const goal = order_ != nullptr ? order_->goal.get() : nullptr;
  if (goal == nullptr || !goal->isOpen()) {
    return;
  }
  const bool reached = std::abs(error_position) < goal_tolerance_;
  if (reached || still_for_ > stall_timeout_) {
    settle(*goal, reached);
  }
}

/// A stalled gripper keeps pressing towards its target: it may hold an object.
template <class HardwareInterface>
void GripperActionController<HardwareInterface>::settle(RealtimeGoal& goal, bool reached) {
  if (!goal.claim()) {
    return;
  }
  goal.handle()->preallocated_result_->position = joint_.getPosition();
  goal.handle()->preallocated_result_->effort = computed_effort_;
  goal.handle()->preallocated_result_->reached_goal = reached;
  goal.handle()->preallocated_result_->stalled = !reached;
  goal.settle(reached ? RealtimeGoal::Outcome::kSucceeded : RealtimeGoal::Outcome::kAborted);
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::publishSnapshot(bool stalled) {
  snapshot_.draft() = Snapshot{joint_.getPosition(), computed_effort_, stalled};
  snapshot_.publish();
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::goalCB(GoalHandle gh) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  const auto reject = [&](const std::string& reason) {
    ROS_ERROR_STREAM_NAMED(name_, "Goal rejected: " << reason);
    gh.setRejected(control_msgs::GripperCommandResult(), reason);
  };
  const std::uint64_t session = session_.load();
  if (!running_.load()) {
    reject("Can't accept new action goals. Controller is not running.");
    return;
  }
  const control_msgs::GripperCommand& command = gh.getGoal()->command;
  if (!std::isfinite(command.position) || !std::isfinite(command.max_effort)) {
    reject("The position and the effort of a goal have to be finite numbers.");
    return;
  }
  if (command.max_effort < 0.0) {
    reject("The effort of a goal has to be at least 0; it applies in both directions.");
    return;
  }
  auto order = std::make_unique<Order>();
  order->commands = Commands{command.position, command.max_effort};
  order->goal = boost::make_shared<RealtimeGoal>(boost::make_shared<RealtimeGoalHandle>(gh));
  order->session = session;
  endGoal("Another goal replaced this one.");
  gh.setAccepted();
  active_goal_ = order->goal;
  active_goal_session_ = session;
  exchange_.put(std::move(order));
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::cancelCB(GoalHandle gh) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  if (!active_goal_ || !(active_goal_->handle()->gh_ == gh)) {
    return;
  }
  if (active_goal_->isOpen() && running_.load()) {
    auto order = std::make_unique<Order>();
    order->session = session_.load();
    exchange_.put(std::move(order));
  }
  endGoal("The client canceled the goal. The gripper now holds its position.");
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::preemptActiveGoal() {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  endGoal("Another command replaced this goal.");
}

/// Cancels the goal unless the loop has just ended it, and reports the result to the client.
template <class HardwareInterface>
void GripperActionController<HardwareInterface>::endGoal(const std::string& reason) {
  if (!active_goal_) {
    return;
  }
  if (active_goal_->claim()) {
    const Snapshot& snapshot = snapshot_.read();
    active_goal_->handle()->preallocated_result_->position = snapshot.position;
    active_goal_->handle()->preallocated_result_->effort = snapshot.effort;
    active_goal_->handle()->preallocated_result_->stalled = snapshot.stalled;
    active_goal_->settle(RealtimeGoal::Outcome::kCanceled);
    sendResult(reason);
    return;
  }
  // Between claim() and settle() of the loop there is no result yet; this takes a microsecond.
  while (!active_goal_->isSettled()) {
    std::this_thread::yield();
  }
  sendResult("");
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::sendResult(const std::string& reason) {
  const control_msgs::GripperCommandResult& result = *active_goal_->handle()->preallocated_result_;
  std::string text = reason;
  if (text.empty()) {
    text = result.reached_goal ? "The gripper reached its goal."
                               : "The gripper stalled at position " +
                                     std::to_string(result.position) + " before its goal.";
  }
  active_goal_->runNonRealtime(text);
  active_goal_.reset();
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::publishFeedback() {
  const Snapshot& snapshot = snapshot_.read();
  control_msgs::GripperCommandFeedback feedback;
  feedback.position = snapshot.position;
  feedback.effort = snapshot.effort;
  feedback.stalled = snapshot.stalled;
  active_goal_->handle()->gh_.publishFeedback(feedback);
}

template <class HardwareInterface>
void GripperActionController<HardwareInterface>::monitor(const ros::WallTimerEvent& /*event*/) {
  const std::lock_guard<std::recursive_mutex> lock(mutex_);
  exchange_.collect([](std::unique_ptr<Order> /*order*/) {});
  if (!active_goal_) {
    return;
  }
  if (active_goal_->isSettled()) {
    sendResult("");
  } else if (active_goal_session_ != session_.load()) {
    endGoal("The controller '" + name_ + "' was stopped before the goal was reached.");
  } else {
    publishFeedback();
  }
}

}  // namespace gripper_action_controller
