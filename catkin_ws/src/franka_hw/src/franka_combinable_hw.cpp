// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka_hw/franka_combinable_hw.h>
#include <franka_hw/resource_helpers.h>
#include <pluginlib/class_list_macros.h>
#include <ros/console.h>
#include <ros/init.h>
#include <std_msgs/Bool.h>

#include <chrono>

namespace franka_hw {

FrankaCombinableHW::~FrankaCombinableHW() {
  connect_server_.shutdown();  // waits for a call under way
  disconnect_server_.shutdown();
  ending_ = true;
  controller_active_ = false;
  if (control_loop_thread_.joinable()) {
    control_loop_thread_.join();
  }
}

bool FrankaCombinableHW::init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) {
  robot_hw_nh_ = robot_hw_nh;
  has_error_publisher_ = robot_hw_nh.advertise<std_msgs::Bool>("has_error", 1, true);
  publishErrorState();
  if (!reconnection_.init(robot_hw_nh) || !FrankaHW::init(root_nh, robot_hw_nh)) {
    return false;
  }
  offerConnection();
  return true;
}

void FrankaCombinableHW::initRobot() {
  FrankaHW::initRobot();
  aborts_ = std::make_unique<AbortReporter>(robot_hw_nh_, arm_id_);
  states_.write({robot_state_libfranka_, ResponseTimes::Clock::now()});
  control_loop_thread_ = std::thread(&FrankaCombinableHW::controlLoop, this);
}

void FrankaCombinableHW::initROSInterfaces(ros::NodeHandle& /*robot_hw_nh*/) {
  setupJointStateInterface(robot_state_ros_);
  setupJointCommandInterface(effort_joint_command_ros_.tau_J, robot_state_ros_, false,
                             effort_joint_interface_);
  setupLimitInterface(effort_joint_limit_interface_, effort_joint_interface_);
  setupFrankaStateInterface(robot_state_ros_);
  setupFrankaModelInterface(robot_state_ros_);
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  offerRobot();
}

// --- connection ----------------------------------------------------------------------------------

void FrankaCombinableHW::connect() {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  if (connected()) {
    return;
  }
  FrankaHW::connect();
  lost_ = false;
  if (initialized_) {
    offerRobot();
    ROS_INFO_STREAM("FrankaCombinableHW: connected to '" << arm_id_ << "'.");
  }
}

bool FrankaCombinableHW::disconnect() {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  if (!controllerActive()) {
    withdrawRobot();  // the services refer to the robot that goes
    lost_ = false;
    setError(false);
  }
  return FrankaHW::disconnect();
}

void FrankaCombinableHW::lose(const std::string& what) {
  const std::lock_guard<std::mutex> lock(connection_mutex_);
  if (!connected()) {
    return;  // given up by somebody meanwhile
  }
  ROS_ERROR_STREAM(arm_id_ << ": " << reconnection_.report(what));
  setError(true);
  lost_ = true;
  withdrawRobot();
  dropConnection();
}

void FrankaCombinableHW::offerConnection() {
  connect_server_ =
      robot_hw_nh_.advertiseService("connect", &FrankaCombinableHW::connectRequested, this);
  disconnect_server_ =
      robot_hw_nh_.advertiseService("disconnect", &FrankaCombinableHW::disconnectRequested, this);
}

bool FrankaCombinableHW::connectRequested(TriggerRequest& /*request*/, TriggerResponse& response) {
  response.success = false;
  if (connected()) {
    response.message = "Already connected to robot. Cannot connect twice.";
    return true;
  }
  try {
    connect();
    response.success = true;
  } catch (const std::exception& error) {
    response.message = "Failed to connect '" + arm_id_ + "': " + error.what();
    ROS_ERROR_STREAM("FrankaCombinableHW: " << response.message);
  }
  return true;
}

bool FrankaCombinableHW::disconnectRequested(TriggerRequest& /*request*/,
                                             TriggerResponse& response) {
  response.success = disconnect();
  response.message = response.success ? ""
                                      : "A controller commands '" + arm_id_ +
                                            "'. Cannot disconnect while it is running.";
  return true;
}

void FrankaCombinableHW::withdrawRobot() {
  if (recovery_server_) {
    // A recovery under way still answers through this pointer: it ends before reset() clears it.
    recovery_server_->shutdown();
  }
  recovery_server_.reset();
  services_.reset();
}

void FrankaCombinableHW::offerRobot() {
  if (!connected()) {
    ROS_ERROR_STREAM("FrankaCombinableHW: '"
                     << arm_id_ << "' is not connected: its services are not offered.");
    return;
  }
  services_ = std::make_unique<ServiceContainer>();
  setupServices(*robot_, robotMutex(), robot_hw_nh_, *services_);
  recovery_server_ = std::make_unique<RecoveryServer>(
      robot_hw_nh_, "error_recovery", [this](const auto& /*goal*/) { recover(); }, false);
  recovery_server_->start();
}

// --- errors --------------------------------------------------------------------------------------

void FrankaCombinableHW::beforeRecovery(std::function<void()> task) {
  before_recovery_ = std::move(task);
}

void FrankaCombinableHW::recover() {
  try {
    if (needsRecovery() && before_recovery_) {
      before_recovery_();
    }
    resetError();
    recovery_server_->setSucceeded();
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("FrankaCombinableHW: '" << arm_id_ << "' did not recover: " << error.what());
    recovery_server_->setAborted(franka_msgs::ErrorRecoveryResult(), error.what());
  }
}

void FrankaCombinableHW::resetError() {
  {
    const auto lock = robot_mutex_.takeWhile([this] { return needsRecovery(); });
    if (!lock) {
      // The robot is not touched: a recovery ahead of time must not clear an error still to come.
      ROS_WARN_STREAM("FrankaCombinableHW: a recovery of '"
                      << arm_id_ << "' was asked for, but there is nothing to recover.");
      return;
    }
    if (!robot_) {
      throw franka::NetworkException("FrankaCombinableHW: '" + arm_id_ +
                                     "' is not connected, so it cannot recover. Call the service "
                                     "connect first.");
    }
    // An error of the controllers' own (NaN, a lost connection) leaves the robot Idle.
    if (robot_->readOnce().robot_mode != franka::RobotMode::kIdle) {
      robot_->automaticErrorRecovery();
    }
  }
  if (has_error_) {
    error_recovered_ = true;
  }
  setError(false);
}

bool FrankaCombinableHW::needsRecovery() const noexcept {
  return has_error_ || connection_.needsRecovery();
}

void FrankaCombinableHW::triggerError() { setError(true); }

bool FrankaCombinableHW::hasError() const noexcept { return has_error_ || waits_for_others_; }

bool FrankaCombinableHW::hasOwnError() const noexcept { return has_error_; }

void FrankaCombinableHW::waitForOthers(bool waits) {
  if (waits_for_others_.exchange(waits) == waits) {
    return;
  }
  error_changed_ = true;
  if (!waits) {
    error_recovered_ = true;
  }
}

bool FrankaCombinableHW::controllerNeedsReset() const noexcept { return controller_needs_reset_; }

std::string FrankaCombinableHW::getArmID() const noexcept { return arm_id_; }

void FrankaCombinableHW::setError(bool has_error) {
  // The controllers' loop sets errors, too: the arm's thread publishes them.
  if (has_error_.exchange(has_error) != has_error) {
    error_changed_ = true;
  }
}

void FrankaCombinableHW::publishErrorState() {
  std_msgs::Bool message;
  message.data = hasError();
  has_error_publisher_.publish(message);
}

// --- the arm's thread ----------------------------------------------------------------------------

void FrankaCombinableHW::controlLoop() {
  while (ros::ok() && !ending_) {
    if (error_changed_.exchange(false)) {
      publishErrorState();
    }
    if (controllerActive() && !hasError() && connected()) {
      moveRobot();
    } else {
      watchRobot();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      robot_mutex_.giveWay();
    }
  }
}

void FrankaCombinableHW::watchRobot() {
  if (connected()) {
    readIdleRobot();
    return;
  }
  if (controllerActive()) {
    setError(true);  // it was given up in the moment in which a controller started
  }
  if (lost_ && initialized_) {
    reconnection_.attempt(arm_id_, [this] { connect(); });
  }
}

void FrankaCombinableHW::readIdleRobot() {
  try {
    const std::lock_guard<std::mutex> lock(robot_mutex_);
    if (robot_ && initialized_) {
      const franka::RobotState state = readPatiently();
      states_.write({state, ResponseTimes::Clock::now()});
    }
  } catch (const franka::Exception& error) {
    lose(error.what());
  }
}

void FrankaCombinableHW::moveRobot() {
  try {
    control();
  } catch (const franka::ControlException& error) {
    abort(error.what(), error.log);
  } catch (const franka::NetworkException& error) {
    aborts_->report(error.what(), {});
    lose(error.what());
  } catch (const std::exception& error) {
    abort(error.what(), {});
  }
  motion_ended_ = ResponseTimes::Clock::now();
}

void FrankaCombinableHW::abort(const std::string& what, const std::vector<franka::Record>& log) {
  setError(true);
  aborts_->report(what, log);
}

void FrankaCombinableHW::control(
    const std::function<bool(const ros::Time&, const ros::Duration&)>& /*ros_callback*/) {
  const InControl in_control(*this);
  if (!controllerActive()) {
    return;
  }
  const ArmConnection::Motion motion(connection_);
  if (!motion) {
    return;
  }
  response_times_.motionBegins();
  try {
    run_function_(*robot_, Callback());
  } catch (const MotionInterrupted&) {
    // The robot was told to stop and braked by itself.
  }
}

franka::Torques FrankaCombinableHW::torqueCallback(const franka::RobotState& robot_state) {
  response_times_.stateArrived(robot_state.time, ResponseTimes::Clock::now());
  states_.write({robot_state, response_times_.lastArrival()});
  if (!controllerActive() || hasError() || ending_) {
    return finished(effort_joint_command_libfranka_, robot_state);
  }
  const Answer& answer = answers_.read();
  // What was computed before the last motion ended does not belong to this one.
  effort_joint_command_libfranka_ =
      answer.since > motion_ended_ ? answer.torques : franka::Torques(std::array<double, 7>{});
  if (commandHasNaN(effort_joint_command_libfranka_)) {
    throw std::invalid_argument("A controller of " + arm_id_ +
                                " commands a torque that is no number (NaN). The motion was ended "
                                "before it reached the robot.");
  }
  response_times_.commandReady(answer.since, ResponseTimes::Clock::now());
  return effort_joint_command_libfranka_;
}

bool FrankaCombinableHW::setRunFunction(const ControlMode& requested_control_mode, bool limit_rate,
                                        double cutoff_frequency,
                                        franka::ControllerMode /*internal_controller*/) {
  if (requested_control_mode == ControlMode::None) {
    return true;
  }
  if (requested_control_mode != ControlMode::JointTorque) {
    ROS_ERROR_STREAM("FrankaCombinableHW: '" << arm_id_ << "' can be commanded torques only, not "
                                             << requested_control_mode << ".");
    return false;
  }
  run_function_ = [=](franka::Robot& robot, Callback /*ros_callback*/) {
    robot.control([this](const franka::RobotState& state,
                         franka::Duration /*step*/) { return torqueCallback(state); },
                  limit_rate, cutoff_frequency);
  };
  return true;
}

// --- the controllers' loop -----------------------------------------------------------------------

bool FrankaCombinableHW::checkForConflict(
    const std::list<hardware_interface::ControllerInfo>& info) const {
  ResourceWithClaimsMap resources = getResourceMap(info);
  if (hasConflictingMultiClaim(resources)) {
    return true;
  }
  ArmClaimedMap claims;
  if (!getArmClaimedMap(resources, claims)) {
    ROS_ERROR("FrankaCombinableHW: a controller claims what is no part of a Franka arm.");
    return true;
  }
  if (hasTrajectoryClaim(claims, arm_id_)) {
    ROS_ERROR_STREAM("FrankaCombinableHW: '" << arm_id_
                                             << "' can be commanded torques only, and a controller "
                                                "claims its positions or velocities.");
    return true;
  }
  return partiallyClaimsArmJoints(claims, arm_id_);
}

bool FrankaCombinableHW::prepareSwitch(
    const std::list<hardware_interface::ControllerInfo>& start_list,
    const std::list<hardware_interface::ControllerInfo>& stop_list) {
  ResourceWithClaimsMap resources = getResourceMap(start_list);
  ArmClaimedMap claims;
  if (initialized_ && !connected() && getArmClaimedMap(resources, claims) &&
      getControlMode(arm_id_, claims) != ControlMode::None) {
    ROS_ERROR_STREAM("FrankaCombinableHW: no controller can command '"
                     << arm_id_ << "', which is not connected. Call its service connect first.");
    return false;
  }
  const bool was_active = controllerActive();
  const bool agrees = FrankaHW::prepareSwitch(start_list, stop_list);
  if (!was_active && controllerActive()) {
    error_recovered_ = true;  // a switch was taken back: its controllers start anew
  }
  return agrees;
}

void FrankaCombinableHW::read(const ros::Time& /*time*/, const ros::Duration& /*period*/) {
  controller_needs_reset_ = error_recovered_.load();
  const ArrivedState& latest = states_.read();
  read_arrival_ = latest.arrival;
  FrankaHW::update(latest.state);
  FrankaCombinableHW::checkJointLimits();
}

void FrankaCombinableHW::write(const ros::Time& /*time*/, const ros::Duration& period) {
  // The controllers have been reset in the cycle between read() and this.
  if (controller_needs_reset_ && error_recovered_) {
    controller_needs_reset_ = false;
    error_recovered_ = false;
  }
  enforceLimits(period);
  answers_.write({effort_joint_command_ros_, read_arrival_});
}

void FrankaCombinableHW::checkJointLimits() { FrankaHW::checkJointLimits(); }

}  // namespace franka_hw

PLUGINLIB_EXPORT_CLASS(franka_hw::FrankaCombinableHW, hardware_interface::RobotHW)
