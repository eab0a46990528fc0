// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka_core/fci/texts.h>
#include <franka_hw/arm_connection.h>
#include <franka_hw/goal_server.h>
#include <franka_hw/services.h>
#include <franka_msgs/ErrorRecoveryAction.h>
#include <ros/console.h>
#include <ros/init.h>
#include <std_msgs/Bool.h>
#include <std_srvs/Trigger.h>

#include <chrono>
#include <utility>

#include "abort_reporter.h"
#include "reconnection.h"

namespace franka_hw {

namespace {

// A robot at rest counts as lost after so many attempts to read a state, or after this time.
constexpr int kReadAttempts = 3;
constexpr std::chrono::seconds kSilenceAtRest{3};

using RecoveryServer = GoalServer<franka_msgs::ErrorRecoveryAction>;
typedef std_srvs::Trigger::Request TriggerRequest;
typedef std_srvs::Trigger::Response TriggerResponse;

}  // namespace

struct ArmConnection::Offer {
  Offer(const ros::NodeHandle& nh, const std::string& arm_id)
      : nh(nh),
        arm_id(arm_id),
        aborts(this->nh, arm_id),
        has_error_publisher(this->nh.advertise<std_msgs::Bool>("has_error", 1, true)) {}

  void publish(bool error) {
    has_error = error;
    std_msgs::Bool message;
    message.data = error;
    has_error_publisher.publish(message);
  }

  ros::NodeHandle nh;
  std::string arm_id;
  AbortReporter aborts;
  ros::Publisher has_error_publisher;
  bool has_error{false};  // the published value; used by the robot's thread
  ros::ServiceServer connect, disconnect;
  // While connected:
  std::unique_ptr<ServiceContainer> setters;
  std::unique_ptr<RecoveryServer> recovery;
};

ArmConnection::ArmConnection(Owner& owner)
    : owner_(owner), reconnection_(std::make_unique<Reconnection>()) {}

ArmConnection::~ArmConnection() { close(); }

bool ArmConnection::init(const ros::NodeHandle& nh) { return reconnection_->init(nh); }

// --- the connection ------------------------------------------------------------------------------

void ArmConnection::connect() {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  if (connected()) {
    return;
  }
  awaitDrop();
  std::unique_ptr<franka::Robot> robot = owner_.openRobot();
  {
    const auto robot_lock = mutex_.take();
    robot_ = std::move(robot);
  }
  state_.handle(ArmEvent::kConnected);
  if (offer_) {
    offerRobot();
    ROS_INFO_STREAM("FrankaHW: connected to '" << offer_->arm_id << "'.");
  }
}

bool ArmConnection::disconnect() {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  if (!state_.handle(ArmEvent::kGivenUp) && connected()) {
    return false;
  }
  awaitDrop();
  dropRobot();
  return true;
}

void ArmConnection::lose(const std::string& what) {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  if (!connected()) {
    return;  // given up in the meantime
  }
  ROS_ERROR_STREAM((offer_ ? offer_->arm_id : "FrankaHW") << ": " << reconnection_->report(what));
  state_.handle(ArmEvent::kLost);
  if (owner_.lossIsError()) {
    fail();
  }
  publishError();
  // In another thread: it waits for a recovery under way, which waits for the robot, or for the
  // loop that this thread may run.
  awaitDrop();
  dropping_ = true;
  drop_thread_ = std::thread([this] {
    dropRobot();
    dropping_ = false;
  });
}

void ArmConnection::dropRobot() {
  withdrawRobot();
  const auto robot_lock = mutex_.take();
  robot_.reset();
}

void ArmConnection::awaitDrop() {
  if (drop_thread_.joinable()) {
    drop_thread_.join();
  }
}

void ArmConnection::reconnect() {
  if (offer_ && isLost(state()) && !dropping_) {
    reconnection_->attempt(offer_->arm_id, [this] { owner_.connect(); });
  }
}

// --- reading and moving --------------------------------------------------------------------------

ArmConnection::Motion::Motion(ArmConnection& arm)
    : lock_(arm.mutex_), state_(arm.state_), begun_(state_.handle(ArmEvent::kMotionStarted)) {}

bool ArmConnection::move(const std::function<void()>& motion) {
  try {
    motion();
    return true;
  } catch (const franka::ControlException& error) {
    abort(ArmEvent::kRobotStopped, error.what(), error.log);
  } catch (const franka::NetworkException& error) {
    offer_->aborts.report(error.what(), {});
    lose(error.what());
  } catch (const std::exception& error) {
    abort(ArmEvent::kFailed, error.what(), {});
  }
  return false;
}

void ArmConnection::abort(ArmEvent event, const std::string& what,
                          const std::vector<franka::Record>& log) {
  state_.handle(event);
  offer_->aborts.report(what, log, robot_ ? robot_->serverVersion() : 0);
}

bool ArmConnection::readAtRest(franka::RobotState& state) {
  if (!connected()) {
    return false;  // a recovery that has not ended yet may hold the mutex
  }
  try {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (connected() && robot_) {
      state = readPatiently([this] { return robot_->readOnce(); });
      return true;
    }
  } catch (const franka::Exception& error) {
    lose(error.what());
  }
  return false;
}

franka::RobotState ArmConnection::readPatiently(
    const std::function<franka::RobotState()>& read,
    const std::function<std::chrono::steady_clock::time_point()>& now) {
  const auto begin = now();
  for (int left = kReadAttempts - 1;; left--) {
    try {
      return read();
    } catch (const franka::NetworkException&) {
      if (left == 0 || now() - begin >= kSilenceAtRest || !ros::ok()) {
        throw;
      }
    }
  }
}

void ArmConnection::publishError() {
  if (offer_ && hasError() != offer_->has_error) {
    offer_->publish(!offer_->has_error);
  }
}

// --- recovery ------------------------------------------------------------------------------------

bool ArmConnection::needsRecovery() const noexcept {
  const franka::RobotMode mode = owner_.robotMode();
  return hasOwnError() || mode == franka::RobotMode::kReflex ||
         mode == franka::RobotMode::kUserStopped;
}

std::string ArmConnection::reasonWithoutEffect() const {
  const bool own = needsRecovery();
  if (!own && !hasError()) {
    return "";
  }
  const franka::RobotMode mode = owner_.robotMode();
  const std::string arm = offer_ ? "'" + offer_->arm_id + "'" : "the robot";
  const std::string recovery = offer_ ? offer_->nh.resolveName("error_recovery") : "error_recovery";
  const bool shown = mode == franka::RobotMode::kReflex || mode == franka::RobotMode::kUserStopped;
  const std::string has_no_effect =
      arm +
      (own && !shown ? " has an error"  // its mode may be that of the last state
                     : std::string(" is in the mode ") +
                           franka_core::fci::modeName(static_cast<franka_core::RobotMode>(mode))) +
      (own ? "" : ", and waits for another arm, which has an error") +
      ": commands of controllers have no effect before ";
  if (!own) {
    return has_no_effect + "that arm has recovered (action error_recovery).";
  }
  return has_no_effect +
         (mode == franka::RobotMode::kUserStopped ? "the user stop is released and the action "
                                                  : "the action ") +
         recovery + " is called.";
}

void ArmConnection::recover() {
  const std::string arm = offer_ ? "'" + offer_->arm_id + "'" : "the robot";
  auto lock = mutex_.takeWhile([this] { return needsRecovery(); });
  if (!lock) {
    // Nothing is sent to the robot: an early recovery must not clear a later error.
    ROS_WARN_STREAM("FrankaHW: a recovery of " << arm
                                               << " was requested, but there is nothing to "
                                                  "recover.");
    return;
  }
  if (!connected() || !robot_) {
    throw franka::NetworkException("FrankaHW: " + arm +
                                   " is not connected, so it cannot recover. Call the service "
                                   "connect first.");
  }
  ROS_INFO_STREAM("FrankaHW: recovering " << arm << " from the error.");
  // After an error of a controller (NaN) or of the connection, the robot is Idle.
  if (robot_->readOnce().robot_mode != franka::RobotMode::kIdle) {
    robot_->automaticErrorRecovery();
  }
  if (before_recovery_) {
    lock.unlock();  // the task may wait for the loop, which reads the robot
    before_recovery_();
  }
  if (hasOwnError()) {
    owner_.errorEnds();
  }
  state_.handle(ArmEvent::kRecovered);
  if (isLost(state())) {
    throw franka::NetworkException("FrankaHW: " + arm + " was lost during its recovery.");
  }
  ROS_INFO_STREAM("FrankaHW: " << arm << " has recovered from the error.");
}

void ArmConnection::handleRecovery() {
  try {
    recover();
    offer_->recovery->setSucceeded();
  } catch (const std::exception& error) {
    std::string reason = error.what();
    if (owner_.robotMode() == franka::RobotMode::kUserStopped) {
      reason +=
          " The user stop is pressed: release it. A robot that does not go on by itself then has "
          "to recover.";
    }
    ROS_ERROR_STREAM("FrankaHW: '" << offer_->arm_id << "' did not recover. " << reason);
    offer_->recovery->setAborted(franka_msgs::ErrorRecoveryResult(), reason);
  }
}

// --- ROS -----------------------------------------------------------------------------------------

void ArmConnection::offer(const ros::NodeHandle& nh, const std::string& arm_id) {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  offer_ = std::make_unique<Offer>(nh, arm_id);
  offer_->publish(hasError());
  offer_->connect = offer_->nh.advertiseService<TriggerRequest, TriggerResponse>(
      "connect", [this](TriggerRequest& /*request*/, TriggerResponse& response) {
        response.success = false;
        if (connected()) {
          response.message = "Already connected to robot. Cannot connect twice.";
          return true;
        }
        try {
          owner_.connect();
          response.success = true;
        } catch (const std::exception& error) {
          response.message = "Failed to connect '" + offer_->arm_id + "': " + error.what();
          ROS_ERROR_STREAM("FrankaHW: " << response.message);
        }
        return true;
      });
  offer_->disconnect = offer_->nh.advertiseService<TriggerRequest, TriggerResponse>(
      "disconnect", [this](TriggerRequest& /*request*/, TriggerResponse& response) {
        response.success = owner_.disconnect();
        response.message = response.success
                               ? ""
                               : "Controller is active. Cannot disconnect while a controller is "
                                 "running. A controller commands '" +
                                     offer_->arm_id + "': stop it first.";
        return true;
      });
  if (connected()) {
    offerRobot();
  }
}

void ArmConnection::close() noexcept {
  if (offer_) {
    offer_->connect.shutdown();
    offer_->disconnect.shutdown();
  }
  awaitDrop();
  withdrawRobot();
  offer_.reset();
}

void ArmConnection::offerRobot() {
  offer_->setters = std::make_unique<ServiceContainer>();
  setupServices(*robot_, mutex_, offer_->nh, *offer_->setters);
  offer_->recovery = std::make_unique<RecoveryServer>(
      offer_->nh, "error_recovery", [this](const auto& /*goal*/) { handleRecovery(); });
  offer_->recovery->start();
}

void ArmConnection::withdrawRobot() noexcept {
  if (offer_ && offer_->recovery) {
    // A running recovery still sends its result through this pointer: shutdown() ends it before
    // reset() clears the pointer.
    offer_->recovery->shutdown();
    offer_->recovery.reset();
    offer_->setters.reset();
  }
}

}  // namespace franka_hw
