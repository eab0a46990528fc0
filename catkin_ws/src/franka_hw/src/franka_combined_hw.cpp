// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka_hw/franka_combined_hw.h>
#include <ros/console.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <string>

namespace franka_hw {

bool FrankaCombinedHW::init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) {
  if (!CombinedRobotHW::init(root_nh, robot_hw_nh)) {
    return false;
  }
  for (const hardware_interface::RobotHWSharedPtr& robot_hw : robot_hw_list_) {
    auto* const arm = dynamic_cast<FrankaCombinableHW*>(robot_hw.get());
    if (arm != nullptr) {
      arms_.push_back(arm);
    } else {
      ROS_WARN(
          "FrankaCombinedHW: one part of robot_hardware is not a FrankaCombinableHW; its errors "
          "and connections are not managed here.");
    }
  }
  setupServices(robot_hw_nh);
  return true;
}

void FrankaCombinedHW::setupServices(ros::NodeHandle& robot_hw_nh) {
  typedef std_srvs::Trigger::Request Request;
  typedef std_srvs::Trigger::Response Response;
  connect_server_ = robot_hw_nh.advertiseService<Request, Response>(
      "connect", [this](Request& /*request*/, Response& response) {
        try {
          connect();
          response.success = true;
        } catch (const std::exception& error) {
          response.success = false;
          response.message =
              std::string("FrankaCombinedHW: Failed to connect robot: ") + error.what();
          ROS_ERROR_STREAM(response.message);
        }
        return true;
      });
  disconnect_server_ = robot_hw_nh.advertiseService<Request, Response>(
      "disconnect", [this](Request& /*request*/, Response& response) {
        response.success = disconnect();
        response.message = response.success ? ""
                                            : "FrankaCombinedHW: Failed to disconnect robot: "
                                              "a controller is active. Stop it first.";
        return true;
      });
  recovery_server_ = std::make_unique<RecoveryServer>(robot_hw_nh, "error_recovery",
                                                      [this](const auto& /*goal*/) { recover(); });
  recovery_server_->start();
}

void FrankaCombinedHW::beforeRecovery(const std::function<void()>& task) {
  for (FrankaCombinableHW* const arm : arms_) {
    arm->armConnection().beforeRecovery(task);
  }
}

void FrankaCombinedHW::recover() {
  if (std::none_of(arms_.begin(), arms_.end(),
                   [](const auto* arm) { return arm->armConnection().needsRecovery(); })) {
    ROS_WARN("FrankaCombinedHW: error_recovery was called, but there is nothing to recover.");
    recovery_server_->setSucceeded();
    return;
  }
  std::string failures;
  for (FrankaCombinableHW* const arm : arms_) {
    const ArmConnection& connection = arm->armConnection();
    if (!connection.hasOwnError() && !(connection.connected() && connection.needsRecovery())) {
      continue;  // has no error, or was given up and stops no other arm
    }
    try {
      arm->resetError();
    } catch (const std::exception& error) {
      failures += (failures.empty() ? "" : " ") + arm->getArmID() + ": " + error.what();
    }
  }
  if (failures.empty()) {
    recovery_server_->setSucceeded();
  } else {
    ROS_ERROR_STREAM("FrankaCombinedHW: " << failures);
    recovery_server_->setAborted(franka_msgs::ErrorRecoveryResult(), failures);
  }
}

void FrankaCombinedHW::read(const ros::Time& time, const ros::Duration& period) {
  stopOthers();
  CombinedRobotHW::read(time, period);
  for (const FrankaCombinableHW* const arm : arms_) {
    reset_due_ = reset_due_ || arm->controllerNeedsReset();
  }
  // An arm may have been recovered since stopOthers(), but then the others wait in this cycle.
  needs_reset_ = reset_due_ && !stopped_;
  reset_due_ = reset_due_ && stopped_;
}

void FrankaCombinedHW::write(const ros::Time& time, const ros::Duration& period) {
  if (!stopped_ && !hasError()) {
    CombinedRobotHW::write(time, period);
  }
}

/// One controller may move all arms: if one arm stops, the others must stop until its recovery. An
/// arm that has been recovered waits for those that have not.
void FrankaCombinedHW::stopOthers() {
  const FrankaCombinableHW* in_error = nullptr;
  int errors = 0;
  for (const FrankaCombinableHW* const arm : arms_) {
    if (arm->armConnection().hasOwnError()) {
      in_error = arm;
      errors++;
    }
  }
  for (FrankaCombinableHW* const arm : arms_) {
    arm->waitForOthers(errors > 1 || (errors == 1 && arm != in_error));
  }
  stopped_ = errors > 0;
}

bool FrankaCombinedHW::prepareSwitch(
    const std::list<hardware_interface::ControllerInfo>& start_list,
    const std::list<hardware_interface::ControllerInfo>& stop_list) {
  for (const hardware_interface::RobotHWSharedPtr& robot : robot_hw_list_) {
    const auto* const arm = dynamic_cast<const FrankaCombinableHW*>(robot.get());
    std::list<hardware_interface::ControllerInfo> start, stop;
    filterControllerList(start_list, start, robot);
    filterControllerList(stop_list, stop, robot);
    if (arm != nullptr && !arm->acceptsSwitch(start, stop)) {
      return false;
    }
  }
  return CombinedRobotHW::prepareSwitch(start_list, stop_list);
}

void FrankaCombinedHW::triggerError() {
  for (FrankaCombinableHW* const arm : arms_) {
    if (arm->controllerActive()) {
      arm->triggerError();
    }
  }
}

bool FrankaCombinedHW::hasError() {
  return std::any_of(arms_.begin(), arms_.end(), [](const auto* arm) { return arm->hasError(); });
}

bool FrankaCombinedHW::controllerNeedsReset() { return needs_reset_; }

void FrankaCombinedHW::connect() {
  std::string failures, connected;
  for (FrankaCombinableHW* const arm : arms_) {
    try {
      arm->connect();
      connected += " '" + arm->getArmID() + "' is connected.";
    } catch (const std::exception& error) {
      failures += (failures.empty() ? "'" : " '") + arm->getArmID() + "': " + error.what();
    }
  }
  if (!failures.empty()) {
    throw franka::NetworkException(failures + connected);
  }
}

bool FrankaCombinedHW::disconnect() {
  if (std::any_of(arms_.begin(), arms_.end(),
                  [](const auto* arm) { return arm->controllerActive(); })) {
    return false;
  }
  bool all = true;
  for (FrankaCombinableHW* const arm : arms_) {
    all = arm->disconnect() && all;
  }
  return all;
}

}  // namespace franka_hw
