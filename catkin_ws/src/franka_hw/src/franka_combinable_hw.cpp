// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/franka_combinable_hw.h>
#include <franka_hw/resource_helpers.h>
#include <franka_hw/robot_wanted.h>
#include <pluginlib/class_list_macros.h>
#include <ros/console.h>
#include <ros/init.h>
#include <std_msgs/Bool.h>

#include <chrono>

namespace franka_hw {

FrankaCombinableHW::~FrankaCombinableHW() {
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
  return FrankaHW::init(root_nh, robot_hw_nh);
}

void FrankaCombinableHW::initRobot() {
  FrankaHW::initRobot();
  states_.write(robot_state_libfranka_);
  control_loop_thread_ = std::thread(&FrankaCombinableHW::controlLoop, this);
}

void FrankaCombinableHW::initROSInterfaces(ros::NodeHandle& /*robot_hw_nh*/) {
  setupJointStateInterface(robot_state_ros_);
  setupJointCommandInterface(effort_joint_command_ros_.tau_J, robot_state_ros_, false,
                             effort_joint_interface_);
  setupLimitInterface(effort_joint_limit_interface_, effort_joint_interface_);
  setupFrankaStateInterface(robot_state_ros_);
  setupFrankaModelInterface(robot_state_ros_);
  setupServicesAndActionServers();
}

// --- connection ----------------------------------------------------------------------------------

void FrankaCombinableHW::connect() {
  FrankaHW::connect();
  connected_ = true;
  if (initialized_) {
    setupServicesAndActionServers();
  }
}

bool FrankaCombinableHW::disconnect() {
  if (!controllerActive()) {
    withdraw();  // the services refer to the robot that goes
  }
  return FrankaHW::disconnect();
}

void FrankaCombinableHW::withdraw() {
  connected_ = false;
  const std::lock_guard<std::mutex> lock(service_mutex_);
  if (recovery_server_) {
    // A recovery under way still answers through this pointer: it ends before reset() clears it.
    recovery_server_->shutdown();
  }
  recovery_server_.reset();
  services_.reset();
}

bool FrankaCombinableHW::connected() { return connected_; }

void FrankaCombinableHW::setupServicesAndActionServers() {
  const std::lock_guard<std::mutex> lock(service_mutex_);
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

void FrankaCombinableHW::recover() {
  try {
    resetError();
    recovery_server_->setSucceeded();
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("FrankaCombinableHW: '" << arm_id_ << "' did not recover: " << error.what());
    recovery_server_->setAborted(franka_msgs::ErrorRecoveryResult(), error.what());
  }
}

void FrankaCombinableHW::resetError() {
  {
    const auto lock = RobotWanted::take(robot_mutex_);
    if (!robot_) {
      throw franka::NetworkException("FrankaCombinableHW: '" + arm_id_ +
                                     "' is not connected, so it cannot recover. Call the service "
                                     "connect first.");
    }
    robot_->automaticErrorRecovery();
  }
  if (has_error_) {
    error_recovered_ = true;
  }
  setError(false);
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

void FrankaCombinableHW::reportError(const std::string& what) {
  ROS_ERROR_STREAM(arm_id_ << ": " << what);
  setError(true);
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
      watchIdleRobot();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      RobotWanted::giveWay();
    }
  }
}

void FrankaCombinableHW::watchIdleRobot() {
  try {
    const std::lock_guard<std::mutex> lock(robot_mutex_);
    if (robot_) {
      const franka::RobotState state = robot_->readOnce();
      robot_state_libfranka_ = state;
      states_.write(state);
    }
  } catch (const franka::Exception& error) {
    reportError(std::string(error.what()) +
                " The connection is given up; call the service connect "
                "when the robot is back.");
    withdraw();
    dropConnection();
  }
}

void FrankaCombinableHW::moveRobot() {
  try {
    // Nothing that was commanded before this motion belongs to it.
    effort_joint_command_libfranka_ = franka::Torques({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
    control();
  } catch (const std::exception& error) {
    reportError(error.what());
  }
}

void FrankaCombinableHW::control(
    const std::function<bool(const ros::Time&, const ros::Duration&)>& /*ros_callback*/) {
  const InControl in_control(*this);
  if (!controllerActive()) {
    return;
  }
  const std::lock_guard<std::mutex> lock(robot_mutex_);
  if (!robot_) {
    return;
  }
  try {
    run_function_(*robot_, Callback());
  } catch (const MotionInterrupted&) {
    // The robot was told to stop and braked by itself.
  }
}

franka::Torques FrankaCombinableHW::torqueCallback(const franka::RobotState& robot_state) {
  states_.write(robot_state);
  if (!controllerActive() || hasError() || ending_) {
    return finished(effort_joint_command_libfranka_, robot_state);
  }
  effort_joint_command_libfranka_ = torques_.read();
  if (commandHasNaN(effort_joint_command_libfranka_)) {
    throw std::invalid_argument("A controller of " + arm_id_ +
                                " commands a torque that is no number (NaN). The motion was ended "
                                "before it reached the robot.");
  }
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

void FrankaCombinableHW::read(const ros::Time& /*time*/, const ros::Duration& /*period*/) {
  controller_needs_reset_ = error_recovered_.load();
  FrankaHW::update(states_.read());
  FrankaCombinableHW::checkJointLimits();
}

void FrankaCombinableHW::write(const ros::Time& /*time*/, const ros::Duration& period) {
  // The controllers have been reset in the cycle between read() and this.
  if (controller_needs_reset_ && error_recovered_) {
    controller_needs_reset_ = false;
    error_recovered_ = false;
  }
  enforceLimits(period);
  torques_.write(effort_joint_command_ros_);
}

void FrankaCombinableHW::checkJointLimits() { FrankaHW::checkJointLimits(); }

}  // namespace franka_hw

PLUGINLIB_EXPORT_CLASS(franka_hw::FrankaCombinableHW, hardware_interface::RobotHW)
