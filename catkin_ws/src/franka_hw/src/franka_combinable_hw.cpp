// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/arm_connection.h>
#include <franka_hw/franka_combinable_hw.h>
#include <franka_hw/resource_helpers.h>
#include <pluginlib/class_list_macros.h>
#include <ros/console.h>
#include <ros/init.h>

#include <chrono>

namespace franka_hw {

namespace {

// How many states in a row a robot leaves without a command before it ends the motion; as many
// repeat a command that nobody renews.
constexpr int kMaxRepetitions = 20;
// Much longer than a robot waits. The limit is for a simulation whose time stands still meanwhile.
constexpr std::chrono::seconds kMaxWait{1};

}  // namespace

FrankaCombinableHW::~FrankaCombinableHW() {
  ending_ = true;
  controller_active_ = false;
  if (control_loop_thread_.joinable()) {
    control_loop_thread_.join();
  }
  connection_->close();
}

bool FrankaCombinableHW::init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) {
  if (!connection_->init(robot_hw_nh) || !FrankaHW::init(root_nh, robot_hw_nh)) {
    return false;
  }
  connection_->offer(robot_hw_nh, arm_id_);
  control_loop_thread_ = std::thread(&FrankaCombinableHW::controlLoop, this);
  return true;
}

void FrankaCombinableHW::initRobot() {
  FrankaHW::initRobot();
  states_.write({robot_state_libfranka_, ResponseTimes::Clock::now()});
}

void FrankaCombinableHW::initROSInterfaces(ros::NodeHandle& /*robot_hw_nh*/) {
  setupJointStateInterface(robot_state_ros_);
  setupJointCommandInterface(effort_joint_command_ros_.tau_J, robot_state_ros_, false,
                             effort_joint_interface_);
  setupLimitInterface(effort_joint_limit_interface_, effort_joint_interface_);
  setupFrankaStateInterface(robot_state_ros_);
  setupFrankaModelInterface(robot_state_ros_);
}

// --- errors --------------------------------------------------------------------------------------

void FrankaCombinableHW::resetError() { connection_->recover(); }

void FrankaCombinableHW::triggerError() { connection_->fail(); }

bool FrankaCombinableHW::hasError() const noexcept { return connection_->hasError(); }

void FrankaCombinableHW::waitForOthers(bool waits) {
  if (connection_->waitForOthers(waits) && !waits) {
    error_recovered_ = true;
  }
}

bool FrankaCombinableHW::controllerNeedsReset() const noexcept { return controller_needs_reset_; }

std::string FrankaCombinableHW::getArmID() const noexcept { return arm_id_; }

// --- the arm's thread ----------------------------------------------------------------------------

void FrankaCombinableHW::controlLoop() {
  while (ros::ok() && !ending_) {
    connection_->publishError();
    if (controllerActive() && !hasError() && connected()) {
      connection_->move([this] { control(); });
      motion_ended_ = ResponseTimes::Clock::now();
    } else {
      watchRobot();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      robot_mutex_.yieldToRequests();
    }
  }
}

void FrankaCombinableHW::watchRobot() {
  franka::RobotState state;
  if (connection_->readAtRest(state)) {
    states_.write({state, ResponseTimes::Clock::now()});
  } else {
    if (controllerActive()) {
      connection_->fail();  // it was given up while a controller started
    }
    connection_->reconnect();
  }
}

void FrankaCombinableHW::control(
    const std::function<bool(const ros::Time&, const ros::Duration&)>& /*ros_callback*/) {
  const InControl in_control(*this);
  if (!controllerActive()) {
    return;
  }
  const ArmConnection::Motion motion(*connection_);
  if (!motion) {
    return;
  }
  response_times_.motionBegins();
  repetitions_ = 0;
  try {
    run_function_(*robot_, Callback());
  } catch (const MotionInterrupted&) {
    // The motion was ended on purpose; the robot has braked by itself.
  }
}

franka::Torques FrankaCombinableHW::torqueCallback(const franka::RobotState& robot_state) {
  response_times_.stateArrived(robot_state.time, ResponseTimes::Clock::now());
  states_.write({robot_state, response_times_.lastArrival()});
  const Answer& answer = awaitAnswer();
  if (!mayMove()) {
    return finished(effort_joint_command_libfranka_, robot_state);
  }
  // Commands computed before the last motion ended do not belong to this one.
  effort_joint_command_libfranka_ =
      answer.since > motion_ended_ ? answer.torques : franka::Torques(std::array<double, 7>{});
  if (commandHasNaN(effort_joint_command_libfranka_)) {
    throw std::invalid_argument(
        "A controller of " + arm_id_ +
        " commands a torque that is not a number (NaN). The motion was ended "
        "before it reached the robot.");
  }
  response_times_.commandReady(answer.since, ResponseTimes::Clock::now());
  return effort_joint_command_libfranka_;
}

bool FrankaCombinableHW::mayMove() const noexcept {
  return controllerActive() && !hasError() && !ending_;
}

/// The latest answer of the controllers' loop; a new one if it was repeated often enough.
const FrankaCombinableHW::Answer& FrankaCombinableHW::awaitAnswer() {
  const auto latest = [this] { return answers_.read().number; };
  ++repetitions_;
  if (repetitions_ > kMaxRepetitions) {
    const auto deadline = ResponseTimes::Clock::now() + kMaxWait;
    while (latest() == last_number_ && mayMove() && ResponseTimes::Clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
  }
  if (latest() != last_number_) {
    last_number_ = answers_.held().number;
    repetitions_ = 0;
  }
  return answers_.held();
}

bool FrankaCombinableHW::supports(ControlMode mode) const {
  return mode == ControlMode::None || mode == ControlMode::JointTorque;
}

bool FrankaCombinableHW::setRunFunction(const ControlMode& requested_control_mode, bool limit_rate,
                                        double cutoff_frequency,
                                        franka::ControllerMode /*internal_controller*/) {
  if (requested_control_mode != ControlMode::JointTorque) {
    return supports(requested_control_mode);
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
    ROS_ERROR("FrankaCombinableHW: a controller claims what is not part of a Franka arm.");
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

bool FrankaCombinableHW::acceptsSwitch(
    const std::list<hardware_interface::ControllerInfo>& start_list,
    const std::list<hardware_interface::ControllerInfo>& stop_list) const {
  if (!FrankaHW::acceptsSwitch(start_list, stop_list)) {
    return false;
  }
  ResourceWithClaimsMap resources = getResourceMap(start_list);
  ArmClaimedMap claims;
  if (initialized_ && !connection_->connected() && !takesBack(start_list, stop_list) &&
      getArmClaimedMap(resources, claims) && getControlMode(arm_id_, claims) != ControlMode::None) {
    ROS_ERROR_STREAM("FrankaCombinableHW: no controller can command '"
                     << arm_id_ << "', which is not connected. Call its service connect first.");
    return false;
  }
  return true;
}

bool FrankaCombinableHW::prepareSwitch(
    const std::list<hardware_interface::ControllerInfo>& start_list,
    const std::list<hardware_interface::ControllerInfo>& stop_list) {
  const bool was_active = controllerActive();
  const bool agrees = FrankaHW::prepareSwitch(start_list, stop_list);
  if (!was_active && controllerActive()) {
    error_recovered_ = true;  // a switch was canceled: its controllers are restarted
  }
  return agrees;
}

void FrankaCombinableHW::read(const ros::Time& /*time*/, const ros::Duration& /*period*/) {
  // In this order: a recovery sets the flag before it ends the error.
  controller_needs_reset_ = !hasError() && error_recovered_.exchange(false);
  const ArrivedState& latest = states_.read();
  read_arrival_ = latest.arrival;
  FrankaHW::update(latest.state);
  FrankaHW::checkJointLimits();
}

void FrankaCombinableHW::write(const ros::Time& /*time*/, const ros::Duration& period) {
  enforceLimits(period);
  answers_.write({effort_joint_command_ros_, read_arrival_, ++cycles_});
}

}  // namespace franka_hw

PLUGINLIB_EXPORT_CLASS(franka_hw::FrankaCombinableHW, hardware_interface::RobotHW)
