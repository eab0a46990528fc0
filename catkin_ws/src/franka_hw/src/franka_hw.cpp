// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// FrankaHW: set-up, connection, interfaces and state.
#include <franka/exception.h>
#include <franka_hw/arm_connection.h>
#include <franka_hw/franka_hw.h>
#include <franka_hw/model.h>
#include <franka_hw/robot_mismatch.h>
#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>
#include <optional>

#include "command_permission.h"
#include "joint_limit_monitor.h"

namespace franka_hw {

namespace {

// Time between two attempts to reach a robot that is starting. [s]
constexpr double kConnectPeriod = 0.2;
// Chosen here: three years; the sum of a longer time and the clock could leave the range of
// ros::Time.
constexpr double kMaxConnectTime = 1e8;  // [s]
// For a user without a robot.
constexpr char kNoRobot[] =
    " Without a robot, start a simulated one: give the launch file sim:=true, or run "
    "`franka_sim --robot panda --ip 127.0.0.1` (or fr3, any loopback address) "
    "in another shell.";

}  // namespace

class FrankaHW::ConnectionOwner final : public ArmConnection::Owner {
 public:
  explicit ConnectionOwner(FrankaHW& hw) : hw_(hw) {}

  std::unique_ptr<franka::Robot> openRobot() override { return hw_.openRobot(); }
  void connect() override { hw_.connect(); }
  bool disconnect() override { return hw_.disconnect(); }
  franka::RobotMode robotMode() const override { return hw_.robotMode(); }
  bool lossIsError() const override { return hw_.lossIsError(); }
  void errorEnds() override { hw_.errorEnds(); }

 private:
  FrankaHW& hw_;
};

FrankaHW::FrankaHW()
    : position_joint_command_libfranka_({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}),
      velocity_joint_command_libfranka_({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}),
      effort_joint_command_libfranka_({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}),
      pose_cartesian_command_libfranka_(
          {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0}),
      velocity_cartesian_command_libfranka_({0.0, 0.0, 0.0, 0.0, 0.0, 0.0}),
      position_joint_command_ros_(position_joint_command_libfranka_),
      velocity_joint_command_ros_(velocity_joint_command_libfranka_),
      effort_joint_command_ros_(effort_joint_command_libfranka_),
      pose_cartesian_command_ros_(pose_cartesian_command_libfranka_),
      velocity_cartesian_command_ros_(velocity_cartesian_command_libfranka_),
      connection_owner_(std::make_unique<ConnectionOwner>(*this)),
      connection_(std::make_unique<ArmConnection>(*connection_owner_)),
      robot_mutex_(connection_->mutex()),
      robot_(connection_->robot()),
      command_permission_(std::make_unique<CommandPermission>(arm_id_, robot_ip_, joint_names_,
                                                              urdf_model_, realtime_config_)) {}

FrankaHW::~FrankaHW() { connection_->close(); }

bool FrankaHW::init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) {
  if (initialized_) {
    ROS_ERROR("FrankaHW: init was called a second time.");
    return false;
  }
  if (!initParameters(root_nh, robot_hw_nh)) {
    ROS_ERROR("FrankaHW: the parameters could not be read (see above).");
    return false;
  }
  try {
    initRobot();
  } catch (const std::runtime_error& error) {
    const bool unreachable = dynamic_cast<const franka::NetworkException*>(&error) != nullptr;
    ROS_ERROR_STREAM("FrankaHW: the robot '" << arm_id_ << "' at " << robot_ip_
                                             << " could not be initialized. " << error.what()
                                             << (unreachable ? kNoRobot : ""));
    return false;
  }
  initROSInterfaces(robot_hw_nh);
  setupParameterCallbacks(robot_hw_nh);
  joint_limit_monitor_ =
      std::make_unique<JointLimitMonitor>(robot_hw_nh, arm_id_, joint_names_, urdf_model_);
  initialized_ = true;
  return true;
}

void FrankaHW::initRobot() {
  connectInTime();
  model_ = std::make_unique<franka_hw::Model>(robot_->loadModel());
  update(robot_->readOnce());
}

void FrankaHW::connectInTime() {
  ROS_INFO_STREAM("FrankaHW: Connecting to the robot '" << arm_id_ << "' at " << robot_ip_ << ".");
  const ros::WallTime deadline =
      ros::WallTime::now() + ros::WallDuration(std::min(connect_timeout_, kMaxConnectTime));
  while (true) {
    try {
      connect();
      return;
    } catch (const franka::NetworkException&) {
      if (ros::WallTime::now() >= deadline || !ros::ok()) {
        throw;
      }
      ros::WallDuration(kConnectPeriod).sleep();
    }
  }
}

void FrankaHW::connect() { connection_->connect(); }

std::unique_ptr<franka::Robot> FrankaHW::openRobot() {
  auto robot = std::make_unique<franka::Robot>(robot_ip_, realtime_config_);
  const CollisionConfig& config = collision_config_;
  robot->setCollisionBehavior(
      config.lower_torque_thresholds_acceleration, config.upper_torque_thresholds_acceleration,
      config.lower_torque_thresholds_nominal, config.upper_torque_thresholds_nominal,
      config.lower_force_thresholds_acceleration, config.upper_force_thresholds_acceleration,
      config.lower_force_thresholds_nominal, config.upper_force_thresholds_nominal);
  const franka::RobotState state = robot->readOnce();
  robot_mode_ = state.robot_mode;
  command_permission_->robotConnected(robot->serverVersion());
  // A robot of protocol 3 reports no F_T_NE.
  const auto& frame = robot->serverVersion() < 4 ? state.F_T_EE : state.F_T_NE;
  const auto described = described_F_T_NE_ ? std::make_optional(*described_F_T_NE_) : std::nullopt;
  const std::string mismatch = endEffectorMismatch(described, frame, arm_id_);
  // Once, not each time that a lost robot is connected again.
  if (!mismatch.empty() && mismatch != reported_mismatch_) {
    ROS_WARN_STREAM("FrankaHW: '" << arm_id_ << "' at " << robot_ip_ << ": " << mismatch
                                  << " Set it as the end effector's transformation in Desk, or "
                                     "describe the tool that is mounted.");
  }
  reported_mismatch_ = mismatch;
  return robot;
}

bool FrankaHW::disconnect() {
  if (controllerActive()) {
    ROS_ERROR("FrankaHW: the connection cannot be ended while a controller is active.");
    return false;
  }
  connection_->disconnect();
  return !connected();
}

bool FrankaHW::connected() { return connection_->connected(); }

franka::Robot& FrankaHW::robot() const {
  if (!initialized_ || !robot_) {
    throw std::logic_error(!initialized_
                               ? "FrankaHW: the robot was requested before init() succeeded."
                               : "FrankaHW: the robot was requested while disconnected.");
  }
  return *robot_;
}

std::mutex& FrankaHW::robotMutex() { return robot_mutex_; }

franka::RobotMode FrankaHW::robotMode() const { return robot_mode_; }

// --- interfaces ----------------------------------------------------------------------------------

void FrankaHW::initROSInterfaces(ros::NodeHandle& /*robot_hw_nh*/) {
  setupJointStateInterface(robot_state_ros_);
  setupJointCommandInterface(position_joint_command_ros_.q, robot_state_ros_, true,
                             position_joint_interface_);
  setupJointCommandInterface(velocity_joint_command_ros_.dq, robot_state_ros_, true,
                             velocity_joint_interface_);
  setupJointCommandInterface(effort_joint_command_ros_.tau_J, robot_state_ros_, false,
                             effort_joint_interface_);
  setupLimitInterface(position_joint_limit_interface_, position_joint_interface_);
  setupLimitInterface(velocity_joint_limit_interface_, velocity_joint_interface_);
  setupLimitInterface(effort_joint_limit_interface_, effort_joint_interface_);
  setupFrankaStateInterface(robot_state_ros_);
  setupFrankaCartesianPoseInterface(pose_cartesian_command_ros_);
  setupFrankaCartesianVelocityInterface(velocity_cartesian_command_ros_);
  setupFrankaModelInterface(robot_state_ros_);
}

void FrankaHW::setupJointStateInterface(franka::RobotState& robot_state) {
  for (size_t i = 0; i < joint_names_.size(); i++) {
    joint_state_interface_.registerHandle(hardware_interface::JointStateHandle(
        joint_names_[i], &robot_state.q[i], &robot_state.dq[i], &robot_state.tau_J[i]));
#if __has_include(<hardware_interface/command_effect_interface.h>)
    command_effect_interface_.registerHandle(hardware_interface::CommandEffectHandle(
        joint_names_[i], [this] { return connection_->reasonWithoutEffect(); }));
  }
  registerInterface(&command_effect_interface_);
#else
  }
#endif
  registerInterface(&joint_state_interface_);
}

void FrankaHW::setupFrankaStateInterface(franka::RobotState& robot_state) {
  franka_state_interface_.registerHandle(FrankaStateHandle(arm_id_ + "_robot", robot_state));
  registerInterface(&franka_state_interface_);
}

void FrankaHW::setupFrankaCartesianPoseInterface(franka::CartesianPose& pose_cartesian_command) {
  franka_pose_cartesian_interface_.registerHandle(
      FrankaCartesianPoseHandle(franka_state_interface_.getHandle(arm_id_ + "_robot"),
                                pose_cartesian_command.O_T_EE, pose_cartesian_command.elbow));
  registerInterface(&franka_pose_cartesian_interface_);
}

void FrankaHW::setupFrankaCartesianVelocityInterface(
    franka::CartesianVelocities& velocity_cartesian_command) {
  franka_velocity_cartesian_interface_.registerHandle(FrankaCartesianVelocityHandle(
      franka_state_interface_.getHandle(arm_id_ + "_robot"), velocity_cartesian_command.O_dP_EE,
      velocity_cartesian_command.elbow));
  registerInterface(&franka_velocity_cartesian_interface_);
}

void FrankaHW::setupFrankaModelInterface(franka::RobotState& robot_state) {
  if (!model_) {
    return;
  }
  franka_model_interface_.registerHandle(
      FrankaModelHandle(arm_id_ + "_model", *model_, robot_state));
  registerInterface(&franka_model_interface_);
}

// --- state and commands --------------------------------------------------------------------------

void FrankaHW::update(const franka::RobotState& robot_state) {
  robot_state_libfranka_ = robot_state;
  robot_state_ros_ = robot_state;
  robot_mode_ = robot_state.robot_mode;
  clock_.update(robot_state.time, ros::Time::now());
}

void FrankaHW::read(const ros::Time& /*time*/, const ros::Duration& /*period*/) {
  robot_state_ros_ = robot_state_libfranka_;
  robot_mode_ = robot_state_ros_.robot_mode;
}

void FrankaHW::write(const ros::Time& /*time*/, const ros::Duration& /*period*/) {
  pose_cartesian_command_libfranka_ = pose_cartesian_command_ros_;
  velocity_cartesian_command_libfranka_ = velocity_cartesian_command_ros_;
  effort_joint_command_libfranka_ = effort_joint_command_ros_;
  position_joint_command_libfranka_ = position_joint_command_ros_;
  velocity_joint_command_libfranka_ = velocity_joint_command_ros_;
}

std::array<double, 7> FrankaHW::getJointPositionCommand() const noexcept {
  return position_joint_command_ros_.q;
}
std::array<double, 7> FrankaHW::getJointVelocityCommand() const noexcept {
  return velocity_joint_command_ros_.dq;
}
std::array<double, 7> FrankaHW::getJointEffortCommand() const noexcept {
  return effort_joint_command_ros_.tau_J;
}

bool FrankaHW::commandHasNaN(const franka::Torques& command) { return arrayHasNaN(command.tau_J); }
bool FrankaHW::commandHasNaN(const franka::JointPositions& command) {
  return arrayHasNaN(command.q);
}
bool FrankaHW::commandHasNaN(const franka::JointVelocities& command) {
  return arrayHasNaN(command.dq);
}
bool FrankaHW::commandHasNaN(const franka::CartesianPose& command) {
  return arrayHasNaN(command.elbow) || arrayHasNaN(command.O_T_EE);
}
bool FrankaHW::commandHasNaN(const franka::CartesianVelocities& command) {
  return arrayHasNaN(command.elbow) || arrayHasNaN(command.O_dP_EE);
}

// --- limits --------------------------------------------------------------------------------------

void FrankaHW::enforceLimits(const ros::Duration& period) {
  if (period.toSec() > 0.0) {
    position_joint_limit_interface_.enforceLimits(period);
    velocity_joint_limit_interface_.enforceLimits(period);
    effort_joint_limit_interface_.enforceLimits(period);
  }
}

void FrankaHW::reset() { position_joint_limit_interface_.reset(); }

void FrankaHW::checkJointLimits() {
  if (joint_limit_monitor_) {
    joint_limit_monitor_->check(robot_state_ros_.q, joint_limit_warning_threshold_);
  }
}

}  // namespace franka_hw
