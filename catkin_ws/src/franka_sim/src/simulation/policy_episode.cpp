// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/motion_limits.h>
#include <franka_core/rotations.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/simulation/policy_episode.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace franka_sim {

namespace {

using Vector7 = Eigen::Matrix<double, 7, 1>;

// Chosen here. Stiffnesses: an arm at an obstacle
// presses with 40 N (kCartesianDelta) or 60 Nm (kJointDelta) at most, which is stiffness times
// lead.
constexpr std::array<double, 7> kFullTorque{15.0, 15.0, 15.0, 15.0,
                                            4.5,  4.5,  4.5};  // of action 1 [Nm]
constexpr double kSpeedWithoutTorque = 1.5;  // nothing is left of action 1 [rad/s]
constexpr double kTorqueMargin = 0.2;        // from the limits [rad]
constexpr double kFading = 2.0;              // of torques, towards them [1/rad]
constexpr double kMaxShare = 2.0;            // of torques, back from them
constexpr double kJointSpeed = 1.0;          // of action 1 [rad/s]
constexpr std::array<double, 7> kPolicyStiffness{400.0, 400.0, 400.0, 400.0,
                                                 200.0, 100.0, 50.0};  // [Nm/rad]
constexpr double kJointLead = 0.15;                                    // [rad]
constexpr double kJointMargin = 0.1;  // from the limits, which targets keep [rad]
constexpr std::array<double, 6> kSpring{2000.0, 2000.0, 2000.0,
                                        100.0,  100.0,  100.0};  // [N/m, Nm/rad]
// Of joints [Nm s/rad]: without, an arm swings at 1 Hz.
constexpr std::array<double, 7> kSwingDamping{5.0, 5.0, 5.0, 5.0, 1.0, 1.0, 1.0};
constexpr double kLead = 0.02;          // [m]
constexpr double kTurnLead = 0.1;       // [rad]
constexpr double kMaxJointSpeed = 1.0;  // of the way that a target takes [rad/s]
constexpr double kSingular = 1e-4;   // damps the joint speeds that are computed near singular poses
constexpr double kMaxTurn = 1.4;     // from the orientation at the start [rad]
constexpr double kGripForce = 20.0;  // [N]
constexpr double kGripSpeed = 0.1;   // [m/s]

template <std::size_t N>
Eigen::Map<const Eigen::Matrix<double, static_cast<int>(N), 1>> vectorOf(
    const std::array<double, N>& values) noexcept {
  return Eigen::Map<const Eigen::Matrix<double, static_cast<int>(N), 1>>(values.data());
}

std::array<double, 7> arrayOf(const Vector7& values) noexcept {
  std::array<double, 7> array;
  Eigen::Map<Vector7>(array.data()) = values;
  return array;
}

/// The vector, or one of the same direction with the largest length allowed.
Eigen::Vector3d shortened(const Eigen::Vector3d& vector, double longest) noexcept {
  const double length = vector.norm();
  return length <= longest ? vector : Eigen::Vector3d(vector * (longest / length));
}

/// The rotation, or the nearest one that is turned from the center by the largest angle [rad].
Eigen::Matrix3d within(const Eigen::Matrix3d& rotation, const Eigen::Matrix3d& center,
                       double largest) noexcept {
  // The trace of a rotation is 1 + 2 cos(angle).
  if (rotation.cwiseProduct(center).sum() >= 1.0 + 2.0 * std::cos(largest)) {
    return rotation;
  }
  const Eigen::Vector3d turn =
      franka_core::vectorOf(Eigen::Matrix3d(rotation * center.transpose()));
  return franka_core::rotationFrom(shortened(turn, largest)) * center;
}

Eigen::Isometry3d poseOf(const std::array<double, 16>& transform) noexcept {
  return Eigen::Isometry3d(Eigen::Map<const Eigen::Matrix4d>(transform.data()));
}

}  // namespace

ArmPolicy::ArmPolicy(PolicyControl control, SimulatedRobot& robot, const Eigen::Isometry3d& base,
                     const PolicyWorkspace& workspace)
    : control_(control),
      robot_(&robot),
      base_(base),
      to_base_(base.inverse()),
      workspace_(workspace) {
  const double margin = control == PolicyControl::kTorque ? kTorqueMargin : kJointMargin;
  for (std::size_t i = 0; i < 7; i++) {
    const franka_core::JointRange range = robot.units().unit().limits().reach(i);
    lowest_[static_cast<int>(i)] = range.lowest + margin;
    highest_[static_cast<int>(i)] = range.highest - margin;
  }
  restart();
}

Eigen::Isometry3d ArmPolicy::worldPose() const noexcept {
  return base_ * poseOf(robot_->state().O_T_EE);
}

void ArmPolicy::restart() noexcept {
  running_ = false;
  start_ = worldPose().linear();
}

void ArmPolicy::apply(const double* action, double seconds) {
  const franka_core::RobotMode mode = robot_->state().robot_mode;
  if (mode != franka_core::RobotMode::kIdle && mode != franka_core::RobotMode::kMove) {
    running_ = false;
    return;
  }
  if (!running_) {
    begin();
    running_ = true;
  }
  switch (control_) {
    case PolicyControl::kTorque:
      applyTorque(Eigen::Map<const Vector7>(action));
      break;
    case PolicyControl::kJointDelta:
      applyJointDelta(Eigen::Map<const Vector7>(action), seconds);
      break;
    case PolicyControl::kCartesianDelta:
      applyCartesianDelta(action, seconds);
      break;
  }
}

void ArmPolicy::begin() {
  const franka_core::RobotState& state = robot_->state();
  if (control_ == PolicyControl::kJointDelta) {
    q_target_ = vectorOf(state.q);
    JointLaw& law = robot_->jointLaw();
    law.setStiffness(kPolicyStiffness);
    law.setTarget(state.q, 0.0);
  } else if (control_ == PolicyControl::kCartesianDelta) {
    target_ = worldPose();
    CartesianLaw& law = robot_->cartesianLaw();
    law.setStiffness(kSpring);
    law.setTarget(state.O_T_EE, 0.0);
    robot_->setDamping(kSwingDamping);
  }
}

// Towards a limit of a joint torques fade, and turn back where it is near.
void ArmPolicy::applyTorque(const Vector7& action) {
  const Vector7 q = vectorOf(robot_->state().q);
  const Vector7 full = vectorOf(kFullTorque);
  const Vector7 lowest = kFading * full.cwiseProduct(lowest_ - q);
  const Vector7 highest = kFading * full.cwiseProduct(highest_ - q);
  const Vector7 torque = full.cwiseProduct(action).cwiseMax(lowest).cwiseMin(highest);
  TorqueShaping shaping;
  shaping.limit_rate = true;
  shaping.damping = arrayOf(full / kSpeedWithoutTorque);
  robot_->commandTorques(arrayOf(torque.cwiseMax(-kMaxShare * full).cwiseMin(kMaxShare * full)),
                         shaping);
}

void ArmPolicy::applyJointDelta(const Vector7& action, double seconds) {
  const Vector7 q = vectorOf(robot_->state().q);
  const Vector7 lead = Vector7::Constant(kJointLead);
  const Vector7 target = q_target_ + (kJointSpeed * seconds) * action;
  q_target_ = target.cwiseMax(lowest_).cwiseMin(highest_).cwiseMax(q - lead).cwiseMin(q + lead);
  robot_->jointLaw().setTarget(arrayOf(q_target_), seconds, TargetMotion::kLinear);
}

void ArmPolicy::applyCartesianDelta(const double* action, double seconds) {
  const Eigen::Isometry3d now = worldPose();
  const Eigen::Vector3d velocity =
      kPolicySpeed * shortened(Eigen::Map<const Eigen::Vector3d>(action), 1.0);
  const Eigen::Vector3d turning =
      kPolicyTurnSpeed * shortened(Eigen::Map<const Eigen::Vector3d>(action + 3), 1.0);
  const double share = seconds * shareOfSpeed(velocity, turning);
  const Eigen::Vector3d position = (target_.translation() + share * velocity)
                                       .cwiseMax(workspace_.lowest)
                                       .cwiseMin(workspace_.highest);
  target_.translation() = now.translation() + shortened(position - now.translation(), kLead);
  const Eigen::Matrix3d turned =
      within(franka_core::rotationFrom(share * turning) * target_.linear(), start_, kMaxTurn);
  target_.linear() = franka_core::orthonormalized(within(turned, now.linear(), kTurnLead));
  std::array<double, 16> O_T_EE;
  Eigen::Map<Eigen::Matrix4d>(O_T_EE.data()) = (to_base_ * target_).matrix();
  robot_->cartesianLaw().setTarget(O_T_EE, seconds, TargetMotion::kLinear);
}

// The share (0 to 1) of an end-effector velocity, in the world, that the joints can follow.
double ArmPolicy::shareOfSpeed(const Eigen::Vector3d& velocity,
                               const Eigen::Vector3d& turning) const noexcept {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  const franka_core::RobotState& state = robot_->state();
  const std::array<double, 42> jacobian = robot_->units().unit().configuration().model.zeroJacobian(
      franka_core::ArmFrame::kEndEffector, state.q, state.F_T_EE, state.EE_T_K);
  const Eigen::Map<const Eigen::Matrix<double, 6, 7>> J(jacobian.data());
  Vector6 twist;
  twist << to_base_.linear() * velocity, to_base_.linear() * turning;
  Matrix6 gram = J.lazyProduct(J.transpose());
  gram.diagonal().array() += kSingular;
  const Vector7 dq = J.transpose() * Vector6(gram.llt().solve(twist));
  return std::min(1.0, kMaxJointSpeed / std::max(dq.cwiseAbs().maxCoeff(), 1e-9));
}

void HandPolicy::apply(double action) noexcept {
  const bool closed = action < 0.0;
  if (closed && !closed_) {
    hand_->grasp(0.0, 0.005, hand_->maxWidth(), kGripSpeed, kGripForce);
  } else if (closed_ && !closed) {
    hand_->move(hand_->maxWidth(), kGripSpeed);
  }
  closed_ = closed;
}

namespace {

constexpr double kMaxRecoveryTime = 1.0;  // [s]; one that succeeds takes less than half of it
constexpr std::size_t kArmSize = 7 + 7 + 3 + 6;
constexpr std::size_t kBodySize = 3 + 4 + 3;

Eigen::Isometry3d baseOf(const RobotSetup& setup) {
  Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
  base.translation() = Eigen::Vector3d(setup.base.data());
  base.linear() = Eigen::AngleAxisd(setup.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return base;
}

}  // namespace

PolicyEpisode::PolicyEpisode(Simulation& simulation, const Setting& setting)
    : simulation_(&simulation), setting_(setting) {
  for (SimulatedRobot& robot : simulation.robots()) {
    const Eigen::Isometry3d base = baseOf(robot.setup());
    robots_.push_back({&robot, base, {setting.control, robot, base, setting.workspace}, false});
    if (setting.hands) {
      GripperUnit* hand = robot.units().hand();
      if (hand == nullptr) {
        throw std::runtime_error("The robot '" + robot.setup().arm_id + "' has no hand.");
      }
      hands_.emplace_back(*hand);
    }
  }
  restart();
}

std::size_t PolicyEpisode::actionSize() const noexcept {
  return robots_.size() * sizeOfAction(setting_.control) + hands_.size();
}

std::size_t PolicyEpisode::observationSize() const noexcept {
  const std::size_t body = setting_.body.empty() ? 0 : kBodySize + robots_.size() + 1;
  return robots_.size() * kArmSize + hands_.size() + body;
}

void PolicyEpisode::restart() {
  reflexes_ = 0;
  waited_ = 0.0;
  for (Robot& robot : robots_) {
    robot.arm.restart();
    robot.stopped = false;
  }
  for (HandPolicy& hand : hands_) {
    hand.restart();
  }
  if (!setting_.body.empty()) {
    before_ = bodyPose(simulation_->world(), setting_.body).position;
  }
}

void PolicyEpisode::apply(const double* action, double seconds) {
  for (std::size_t i = 0; i < robots_.size(); i++) {
    robots_[i].arm.apply(action, seconds);
    action += sizeOfAction(setting_.control);
    if (!hands_.empty()) {
      hands_[i].apply(*action++);
    }
  }
}

void PolicyEpisode::recover(double seconds) {
  for (Robot& robot : robots_) {
    const bool stopped = robot.robot->state().robot_mode == franka_core::RobotMode::kReflex;
    reflexes_ += stopped && !robot.stopped ? 1 : 0;
    robot.stopped = stopped;
    if (stopped) {
      try {
        robot.robot->recover();
      } catch (const RequestRefused&) {  // it still brakes: the next step tries again
      }
    }
  }
  waited_ = stopped() ? waited_ + seconds : 0.0;
}

bool PolicyEpisode::stopped() const noexcept {
  return std::any_of(robots_.begin(), robots_.end(),
                     [](const Robot& robot) { return robot.stopped; });
}

bool PolicyEpisode::stuck() const noexcept { return waited_ > kMaxRecoveryTime; }

void PolicyEpisode::observe(double seconds, double* observation) {
  double* to = observation;
  const auto put = [&to](const auto& values) { to = std::copy(values.begin(), values.end(), to); };
  for (std::size_t i = 0; i < robots_.size(); i++) {
    const franka_core::RobotState& state = robots_[i].robot->state();
    put(state.q);
    put(state.dq);
    const Eigen::Matrix4d tool =
        robots_[i].base.matrix() * Eigen::Map<const Eigen::Matrix4d>(state.O_T_EE.data());
    for (const int column : {3, 0, 1}) {
      to = std::copy_n(tool.col(column).data(), 3, to);
    }
    if (!hands_.empty()) {
      *to++ = robots_[i].robot->units().hand()->width();
    }
  }
  if (!setting_.body.empty()) {
    observeBody(seconds, to);
  }
}

void PolicyEpisode::observeBody(double seconds, double* to) {
  const World& world = simulation_->world();
  const Pose pose = bodyPose(world, setting_.body);
  to = std::copy(pose.position.begin(), pose.position.end(), to);
  const double sign = pose.orientation[0] >= 0.0 ? 1.0 : -1.0;
  for (const double value : pose.orientation) {
    *to++ = sign * value;
  }
  for (std::size_t i = 0; i < 3; i++) {
    *to++ = seconds > 0.0 ? (pose.position[i] - before_[i]) / seconds : 0.0;
  }
  before_ = pose.position;
  const Touches touching = touches(world, setting_.body);
  for (const Robot& robot : robots_) {
    const auto found =
        std::find(touching.robots.begin(), touching.robots.end(), robot.robot->setup().arm_id);
    *to++ = found == touching.robots.end() ? 0.0 : 1.0;
  }
  *to = touching.others ? 1.0 : 0.0;
}

}  // namespace franka_sim
