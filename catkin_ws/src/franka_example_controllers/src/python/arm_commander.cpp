// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "arm_commander.h"

#include <franka_example_controllers/command_claims.h>
#include <franka_example_controllers/robot_handles.h>
#include <franka_example_controllers/torque_rate.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace franka_example_controllers {

namespace {

using franka_hw::ControlMode;
using Matrix4 = Eigen::Matrix4d;

// Below the smallest of the Panda's limits of each kind: 7.5 rad/s^2 of joint 2, 13 m/s^2 and 25
// rad/s^2 of the end effector, 5 rad/s^2 of the elbow.
constexpr double kJointDeceleration = 5.0;
constexpr double kCartesianDeceleration = 2.0;
constexpr double kElbowDeceleration = 2.0;

// Those of the joint impedance example, which are stable at 1 kHz.
constexpr std::array<double, 7> kDamping{{50.0, 50.0, 50.0, 20.0, 20.0, 20.0, 10.0}};  // [Nm s/rad]
constexpr double kAtRest = 0.02;      // [rad/s] of each joint
constexpr double kMaxRestTime = 2.0;  // [s]

/// The twist in O from one pose to the next within a time.
std::array<double, 6> twistBetween(const std::array<double, 16>& from,
                                   const std::array<double, 16>& to, double period) {
  std::array<double, 6> twist;
  const Eigen::Map<const Matrix4> a(from.data());
  const Eigen::Map<const Matrix4> b(to.data());
  const Eigen::Matrix3d rotation = b.topLeftCorner<3, 3>() * a.topLeftCorner<3, 3>().transpose();
  const Eigen::AngleAxisd turn(rotation);
  Eigen::Map<Eigen::Vector3d>(twist.data()) =
      (b.topRightCorner<3, 1>() - a.topRightCorner<3, 1>()) / period;
  Eigen::Map<Eigen::Vector3d>(twist.data() + 3) = turn.angle() * turn.axis() / period;
  return twist;
}

void advance(std::array<double, 16>& pose, const std::array<double, 6>& twist, double period) {
  Eigen::Map<Matrix4> matrix(pose.data());
  matrix.topRightCorner<3, 1>() += period * Eigen::Map<const Eigen::Vector3d>(twist.data());
  const Eigen::Vector3d turn = period * Eigen::Map<const Eigen::Vector3d>(twist.data() + 3);
  const double angle = turn.norm();
  if (angle > 0.0) {
    const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
    Eigen::Quaterniond orientation(Eigen::AngleAxisd(angle, turn / angle) * rotation);
    matrix.topLeftCorner<3, 3>() = orientation.normalized().toRotationMatrix();
  }
}

}  // namespace

void ArmCommander::take(hardware_interface::RobotHW* robot_hw, const std::string& arm_id,
                        const std::vector<std::string>& joint_names, ControlMode mode) {
  mode_ = mode;
  if (commands(mode, ControlMode::JointPosition)) {
    motion_handles_ = takeJoints<hardware_interface::PositionJointInterface>(robot_hw, joint_names);
  }
  if (commands(mode, ControlMode::JointVelocity)) {
    motion_handles_ = takeJoints<hardware_interface::VelocityJointInterface>(robot_hw, joint_names);
  }
  if (commands(mode, ControlMode::JointTorque)) {
    effort_handles_ = takeJoints<hardware_interface::EffortJointInterface>(robot_hw, joint_names);
  }
  if (commands(mode, ControlMode::CartesianPose)) {
    pose_handle_ = std::make_unique<franka_hw::FrankaCartesianPoseHandle>(
        takeHandle<franka_hw::FrankaPoseCartesianInterface>(robot_hw, arm_id + "_robot"));
  }
  if (commands(mode, ControlMode::CartesianVelocity)) {
    twist_handle_ = std::make_unique<franka_hw::FrankaCartesianVelocityHandle>(
        takeHandle<franka_hw::FrankaVelocityCartesianInterface>(robot_hw, arm_id + "_robot"));
  }
}

void ArmCommander::send(const ArmCommand& command) {
  for (std::size_t i = 0; i < motion_handles_.size(); ++i) {
    motion_handles_[i].setCommand(command.joints[i]);
  }
  for (std::size_t i = 0; i < effort_handles_.size(); ++i) {
    effort_handles_[i].setCommand(command.effort[i]);
  }
  if (pose_handle_) {
    pose_handle_->setCommand(command.pose, command.elbow);
  }
  if (twist_handle_) {
    twist_handle_->setCommand(command.twist, command.elbow);
  }
  last_ = command;
}

void ArmCommander::holdStill(const franka::RobotState& state) {
  ArmCommand still;
  if (commands(mode_, ControlMode::JointPosition)) {
    still.joints = state.q_d;
  }
  still.pose = state.O_T_EE_d;
  send(still);
  joints_.reset(still.joints);
  twist_.reset({});
  elbow_.reset({});
}

void ArmCommander::command(const ArmCommand& command, double period) {
  joints_.add(command.joints, period);
  noteCartesian(command, period);
  send(command);
}

void ArmCommander::noteCartesian(const ArmCommand& command, double period) {
  if (commands(mode_, ControlMode::CartesianPose)) {
    twist_.add(
        period > 0.0 ? twistBetween(last_.pose, command.pose, period) : std::array<double, 6>{},
        period);
  } else {
    twist_.add(command.twist, period);
  }
  if (command.elbow[1] == last_.elbow[1]) {
    elbow_.add({{command.elbow[0]}}, period);
  } else {
    elbow_.reset({{command.elbow[0]}});
  }
}

void ArmCommander::beginRest() {
  resting_ = 0.0;
  joint_stop_ = commands(mode_, ControlMode::JointPosition)
                    ? GentleStop<7>(joints_.first(), joints_.second(), kJointDeceleration)
                    : GentleStop<7>(joints_.last(), joints_.first(), kJointDeceleration);
  twist_stop_ = GentleStop<6>(twist_.last(), twist_.first(), kCartesianDeceleration);
  elbow_stop_ = GentleStop<1>(elbow_.first(), elbow_.second(), kElbowDeceleration);
}

void ArmCommander::restMotion(ArmCommand& command, double period) const {
  const std::array<double, 7> joint_velocity = joint_stop_.velocity(resting_);
  if (commands(mode_, ControlMode::JointPosition)) {
    for (std::size_t i = 0; i < joint_velocity.size(); ++i) {
      command.joints[i] += period * joint_velocity[i];
    }
  } else {
    command.joints = joint_velocity;
  }
  command.twist = twist_stop_.velocity(resting_);
  advance(command.pose, command.twist, period);
  if (command.elbow[1] != 0.0) {
    command.elbow[0] += period * elbow_stop_.velocity(resting_)[0];
  }
}

std::array<double, 7> ArmCommander::damping(const franka::RobotState& state) const {
  std::array<double, 7> torques;
  for (std::size_t i = 0; i < torques.size(); ++i) {
    torques[i] = -kDamping[i] * state.dq[i];
  }
  return saturateTorqueRate(torques, last_.effort);
}

bool ArmCommander::rest(const franka::RobotState& state, double period) {
  resting_ += period;
  ArmCommand command = last_;
  restMotion(command, period);
  command.effort = damping(state);
  send(command);
  const bool slow = std::all_of(state.dq.begin(), state.dq.end(),
                                [](double speed) { return std::abs(speed) < kAtRest; });
  const double longest =
      std::max({joint_stop_.duration(), twist_stop_.duration(), elbow_stop_.duration()});
  return resting_ >= longest && (slow || resting_ >= longest + kMaxRestTime);
}

}  // namespace franka_example_controllers
