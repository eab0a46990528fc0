// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka/robot.h>
#include <franka_core/fci/texts.h>
#include <franka_core/typed_transform.h>

#include "franka/control_loop.h"
#include "franka/robot_impl.h"
#include "franka/warning.h"

namespace franka {

namespace fci = franka_core::fci;

namespace {

/// The transform of a matrix that a user typed; logs its correction.
/// @throws CommandException with the robot's text if it is not a transform
std::array<double, 16> readFrame(fci::Command command, const std::string& name,
                                 const std::array<double, 16>& matrix) {
  const franka_core::TypedTransform typed = franka_core::readTypedTransform(matrix);
  if (!typed.fault.empty()) {
    throw CommandException(fci::statusText(command, fci::Status::kInvalidArgumentRejected,
                                           franka_core::RobotMode::kIdle) +
                           " " + name + " is not a column-major 4x4 transform: " + typed.fault +
                           ".");
  }
  if (!typed.warning.empty()) {
    logging::warn("libfranka: " + name + ": " + typed.warning + ".");
  }
  return typed.matrix;
}

}  // namespace

Robot::Robot(const std::string& franka_address, RealtimeConfig realtime_config, size_t log_size)
    : impl_(std::make_shared<Impl>(franka_address, realtime_config, log_size)) {}

Robot::Robot(Robot&& other) noexcept = default;
Robot& Robot::operator=(Robot&& other) noexcept = default;
Robot::~Robot() noexcept = default;

Robot::ServerVersion Robot::serverVersion() const noexcept { return impl_->version(); }

void Robot::setControlOptions(const ControlOptions& options) { impl_->options() = options; }

void Robot::control(std::function<Torques(const RobotState&, Duration)> control_callback,
                    bool limit_rate, double cutoff_frequency) {
  runTorqueLoop(*impl_, control_callback, {limit_rate, cutoff_frequency});
}

void Robot::control(
    std::function<Torques(const RobotState&, Duration)> control_callback,
    std::function<JointPositions(const RobotState&, Duration)> motion_generator_callback,
    bool limit_rate, double cutoff_frequency) {
  runMotionLoop(*impl_, control_callback, motion_generator_callback,
                {limit_rate, cutoff_frequency});
}

void Robot::control(
    std::function<Torques(const RobotState&, Duration)> control_callback,
    std::function<JointVelocities(const RobotState&, Duration)> motion_generator_callback,
    bool limit_rate, double cutoff_frequency) {
  runMotionLoop(*impl_, control_callback, motion_generator_callback,
                {limit_rate, cutoff_frequency});
}

void Robot::control(
    std::function<Torques(const RobotState&, Duration)> control_callback,
    std::function<CartesianPose(const RobotState&, Duration)> motion_generator_callback,
    bool limit_rate, double cutoff_frequency) {
  runMotionLoop(*impl_, control_callback, motion_generator_callback,
                {limit_rate, cutoff_frequency});
}

void Robot::control(
    std::function<Torques(const RobotState&, Duration)> control_callback,
    std::function<CartesianVelocities(const RobotState&, Duration)> motion_generator_callback,
    bool limit_rate, double cutoff_frequency) {
  runMotionLoop(*impl_, control_callback, motion_generator_callback,
                {limit_rate, cutoff_frequency});
}

void Robot::control(
    std::function<JointPositions(const RobotState&, Duration)> motion_generator_callback,
    ControllerMode controller_mode, bool limit_rate, double cutoff_frequency) {
  runMotionLoop(*impl_, motion_generator_callback, controller_mode, {limit_rate, cutoff_frequency});
}

void Robot::control(
    std::function<JointVelocities(const RobotState&, Duration)> motion_generator_callback,
    ControllerMode controller_mode, bool limit_rate, double cutoff_frequency) {
  runMotionLoop(*impl_, motion_generator_callback, controller_mode, {limit_rate, cutoff_frequency});
}

void Robot::control(
    std::function<CartesianPose(const RobotState&, Duration)> motion_generator_callback,
    ControllerMode controller_mode, bool limit_rate, double cutoff_frequency) {
  runMotionLoop(*impl_, motion_generator_callback, controller_mode, {limit_rate, cutoff_frequency});
}

void Robot::control(
    std::function<CartesianVelocities(const RobotState&, Duration)> motion_generator_callback,
    ControllerMode controller_mode, bool limit_rate, double cutoff_frequency) {
  runMotionLoop(*impl_, motion_generator_callback, controller_mode, {limit_rate, cutoff_frequency});
}

void Robot::read(std::function<bool(const RobotState&)> read_callback) {
  impl_->read(read_callback);
}

RobotState Robot::readOnce() { return impl_->readOnce(); }

VirtualWallCuboid Robot::getVirtualWall(int32_t id) {
  const fci::CartesianLimit wall =
      impl_->execute(fci::GetCartesianLimitRequest{id}).cartesian_limit;
  return {id, wall.object_world_size, wall.object_frame, wall.active};
}

void Robot::setCollisionBehavior(const std::array<double, 7>& lower_torque_thresholds_acceleration,
                                 const std::array<double, 7>& upper_torque_thresholds_acceleration,
                                 const std::array<double, 7>& lower_torque_thresholds_nominal,
                                 const std::array<double, 7>& upper_torque_thresholds_nominal,
                                 const std::array<double, 6>& lower_force_thresholds_acceleration,
                                 const std::array<double, 6>& upper_force_thresholds_acceleration,
                                 const std::array<double, 6>& lower_force_thresholds_nominal,
                                 const std::array<double, 6>& upper_force_thresholds_nominal) {
  impl_->execute(fci::SetCollisionBehaviorRequest{
      lower_torque_thresholds_acceleration, upper_torque_thresholds_acceleration,
      lower_torque_thresholds_nominal, upper_torque_thresholds_nominal,
      lower_force_thresholds_acceleration, upper_force_thresholds_acceleration,
      lower_force_thresholds_nominal, upper_force_thresholds_nominal});
}

void Robot::setCollisionBehavior(const std::array<double, 7>& lower_torque_thresholds,
                                 const std::array<double, 7>& upper_torque_thresholds,
                                 const std::array<double, 6>& lower_force_thresholds,
                                 const std::array<double, 6>& upper_force_thresholds) {
  setCollisionBehavior(lower_torque_thresholds, upper_torque_thresholds, lower_torque_thresholds,
                       upper_torque_thresholds, lower_force_thresholds, upper_force_thresholds,
                       lower_force_thresholds, upper_force_thresholds);
}

void Robot::setJointImpedance(const std::array<double, 7>& K_theta) {
  impl_->execute(fci::SetJointImpedanceRequest{K_theta});
}

void Robot::setCartesianImpedance(const std::array<double, 6>& K_x) {
  impl_->execute(fci::SetCartesianImpedanceRequest{K_x});
}

void Robot::setGuidingMode(const std::array<bool, 6>& guiding_mode, bool elbow) {
  impl_->execute(fci::SetGuidingModeRequest{guiding_mode, elbow});
}

void Robot::setK(const std::array<double, 16>& EE_T_K) {
  impl_->execute(fci::SetEEToKRequest{readFrame(fci::Command::kSetEEToK, "EE_T_K", EE_T_K)});
}

void Robot::setEE(const std::array<double, 16>& NE_T_EE) {
  impl_->execute(fci::SetNEToEERequest{readFrame(fci::Command::kSetNEToEE, "NE_T_EE", NE_T_EE)});
}

void Robot::setLoad(double load_mass, const std::array<double, 3>& F_x_Cload,
                    const std::array<double, 9>& load_inertia) {
  impl_->execute(fci::SetLoadRequest{load_mass, F_x_Cload, load_inertia});
}

void Robot::setFilters(double joint_position_filter_frequency,
                       double joint_velocity_filter_frequency,
                       double cartesian_position_filter_frequency,
                       double cartesian_velocity_filter_frequency,
                       double controller_filter_frequency) {
  impl_->execute(
      fci::SetFiltersRequest{joint_position_filter_frequency, joint_velocity_filter_frequency,
                             cartesian_position_filter_frequency,
                             cartesian_velocity_filter_frequency, controller_filter_frequency});
}

void Robot::automaticErrorRecovery() { impl_->execute(fci::AutomaticErrorRecoveryRequest{}); }

void Robot::stop() { impl_->execute(fci::StopMoveRequest{}); }

std::string Robot::getRobotModel() {
  const std::vector<std::uint8_t> urdf = impl_->download(fci::GetRobotModelRequest{});
  return {urdf.begin(), urdf.end()};
}

bool Robot::isMobileRobot() const noexcept { return impl_->isMobile(); }

std::array<double, 7> Robot::getUpperJointVelocityLimits(
    const std::array<double, 7>& joint_positions) const noexcept {
  return impl_->limits().upperJointVelocity(joint_positions);
}

std::array<double, 7> Robot::getLowerJointVelocityLimits(
    const std::array<double, 7>& joint_positions) const noexcept {
  return impl_->limits().lowerJointVelocity(joint_positions);
}

}  // namespace franka
