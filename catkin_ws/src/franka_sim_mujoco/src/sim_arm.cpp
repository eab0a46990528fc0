// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/lowpass_filter.h>
#include <franka_core/finite.h>
#include <franka_core/to_franka.h>
#include <franka_core/transform.h>
#include <franka_sim_mujoco/sim_arm.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace franka_sim_mujoco {

namespace {

using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;
using franka_hw::ControlMode;

template <std::size_t N>
void smooth(double alpha, const std::array<double, N>& signal,
            std::array<double, N>& filtered) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    filtered[i] += alpha * (signal[i] - filtered[i]);
  }
}

/// Bit for bit: a command that is not a number equals itself.
bool equal(const ArmCommands& a, const ArmCommands& b) noexcept {
  static_assert(std::is_trivially_copyable_v<ArmCommands>);
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Goes a part of the way, below 1, to values. Values that are not finite are taken as they are.
template <std::size_t N>
void approach(double part, const std::array<double, N>& to, std::array<double, N>& value) noexcept {
  if (!franka_core::allFinite(to) || !franka_core::allFinite(value)) {
    value = to;
    return;
  }
  smooth(part, to, value);
}

/// Another sign of joint 4, or an elbow that was free or becomes it, has no way between.
void approachElbow(double part, const std::array<double, 2>& to,
                   std::array<double, 2>& elbow) noexcept {
  if (to[1] != elbow[1]) {
    elbow = to;
    return;
  }
  approach(part, to, elbow);
}

void approachPose(double part, const std::array<double, 16>& to,
                  std::array<double, 16>& pose) noexcept {
  if (!franka_core::isHomogeneousTransformation(to) ||
      !franka_core::isHomogeneousTransformation(pose)) {
    pose = to;
    return;
  }
  // The cutoff frequency for which a step of the filter goes this part of the way.
  const double cutoff = part / ((1.0 - part) * 2.0 * M_PI * franka_sim::kTick);
  try {
    pose = franka::cartesianLowpassFilter(franka_sim::kTick, to, pose, cutoff);
  } catch (...) {
    pose = to;  // another libfranka may check more
  }
}

bool isFinite(const franka_core::RobotCommand& command) noexcept {
  return franka_core::allFinite(command.tau_J_d) && franka_core::allFinite(command.q_c) &&
         franka_core::allFinite(command.dq_c) && franka_core::allFinite(command.O_T_EE_c) &&
         franka_core::allFinite(command.O_dP_EE_c) && franka_core::allFinite(command.elbow_c);
}

/// An arm at full speed comes to rest within half a second.
constexpr int kMaxStopTime = 2000;  // [ticks]

MotionGeneratorMode generatorOf(ControlMode mode) noexcept {
  if (contains(mode, ControlMode::JointPosition)) {
    return MotionGeneratorMode::kJointPosition;
  }
  if (contains(mode, ControlMode::JointVelocity)) {
    return MotionGeneratorMode::kJointVelocity;
  }
  if (contains(mode, ControlMode::CartesianPose)) {
    return MotionGeneratorMode::kCartesianPosition;
  }
  if (contains(mode, ControlMode::CartesianVelocity)) {
    return MotionGeneratorMode::kCartesianVelocity;
  }
  return MotionGeneratorMode::kNone;
}

bool isCartesian(ControlMode mode) noexcept {
  return contains(mode, ControlMode::CartesianPose | ControlMode::CartesianVelocity);
}

}  // namespace

SimArm::SimArm(const franka_sim::ControlUnitParameters& parameters, franka_sim::ArmPlant& plant,
               const SimArmOptions& options)
    : unit_(parameters), plant_(plant), options_(options) {
  unit_.request(franka_sim::UserStop{false});
}

// --- a tick --------------------------------------------------------------------------------------

void SimArm::read(const ros::Time& time) noexcept {
  unit_.observe(plant_.measure());
  if (waits_) {
    tryToStart();
  }
  time_ = franka::Duration(time.toNSec() / 1000000);
  if (options_.filter_alpha < 1.0) {
    filter();
  }
  updateState();
  reportCondition();
}

void SimArm::updateState() noexcept {
  franka_core::toFranka(unit_.state(), state_);
  state_.time = time_;
  if (options_.filter_alpha < 1.0) {
    state_.tau_ext_hat_filtered = tau_ext_filtered_;
    state_.O_F_ext_hat_K = O_F_ext_filtered_;
    state_.K_F_ext_hat_K = K_F_ext_filtered_;
    updateContacts();
  }
}

// The manual's formulas use the published values; reflexes have a different rule.
void SimArm::updateContacts() noexcept {
  if (hasReflexes(unit_.configuration().rules)) {
    return;
  }
  const franka_sim::CollisionThresholds thresholds = unit_.status().thresholds;
  state_.joint_contact = franka_sim::above(state_.tau_ext_hat_filtered, thresholds.lower_torque);
  state_.joint_collision = franka_sim::above(state_.tau_ext_hat_filtered, thresholds.upper_torque);
  state_.cartesian_contact = franka_sim::above(state_.K_F_ext_hat_K, thresholds.lower_force);
  state_.cartesian_collision = franka_sim::above(state_.K_F_ext_hat_K, thresholds.upper_force);
}

void SimArm::filter() noexcept {
  const franka_core::RobotState& state = unit_.state();
  const double alpha = filter_is_fresh_ ? 1.0 : options_.filter_alpha;
  smooth(alpha, state.tau_ext_hat_filtered, tau_ext_filtered_);
  smooth(alpha, state.O_F_ext_hat_K, O_F_ext_filtered_);
  smooth(alpha, state.K_F_ext_hat_K, K_F_ext_filtered_);
  filter_is_fresh_ = false;
}

void SimArm::approachCommands() noexcept {
  if (!equal(commands_, target_)) {
    target_ = commands_;
    ticks_to_target_ = options_.control_ticks;
  }
  if (ticks_to_target_ <= 1) {
    applied_ = commands_;
    return;
  }
  const double part = 1.0 / ticks_to_target_--;
  applied_.torque = commands_.torque;
  approach(part, commands_.position, applied_.position);
  approach(part, commands_.velocity, applied_.velocity);
  approachPose(part, commands_.pose, applied_.pose);
  approachElbow(part, commands_.pose_elbow, applied_.pose_elbow);
  approach(part, commands_.twist, applied_.twist);
  approachElbow(part, commands_.twist_elbow, applied_.twist_elbow);
}

void SimArm::write() noexcept {
  const std::array<double, 7>& motor_torque = unit_.actuate(command());
  plant_.setBrakes(unit_.status().brakes_closed);
  plant_.applyTorques(motor_torque);
}

const franka_core::RobotCommand* SimArm::command() noexcept {
  if (unit_.state().robot_mode != RobotMode::kMove || waits_) {
    return nullptr;
  }
  command_ = shapeCommand(options_.shaping, mode_, applied_, unit_.state(), unit_.limits());
  if (isFinite(command_)) {
    return &command_;
  }
  refused_commands_.fetch_add(1, std::memory_order_relaxed);
  return generates() ? &command_ : nullptr;
}

// Passes the condition of the arm to other threads.
void SimArm::reportCondition() noexcept {
  const bool faulty = unit_.state().robot_mode == RobotMode::kReflex;
  if (faulty && !faulty_.load(std::memory_order_relaxed)) {
    ++last_abort_.count;
    last_abort_.errors = unit_.state().errors;
    last_abort_.joint_collision = unit_.status().joint_collision;
    last_abort_.cartesian_collision = unit_.status().cartesian_collision;
    last_abort_.pose = command_.O_T_EE_c;
    abort_.write(last_abort_);
  }
  faulty_.store(faulty, std::memory_order_relaxed);
}

// --- controllers come and go ---------------------------------------------------------------------

bool SimArm::generates() const noexcept { return generatorOf(mode_) != MotionGeneratorMode::kNone; }

bool SimArm::canConnect() const noexcept {
  return !userStopped() && connected() &&
         (unit_.state().robot_mode == RobotMode::kIdle ||
          unit_.state().robot_mode == RobotMode::kMove);
}

bool SimArm::refuses(ControlMode starts, ControlMode stops) const noexcept {
  return starts != ControlMode::None && isCartesian((mode_ & ~stops) | starts) && canConnect() &&
         unit_.stopsAtSingularPose();
}

bool SimArm::control(ControlMode starts, ControlMode stops) noexcept {
  if (starts == ControlMode::None && stops == ControlMode::None) {
    return false;  // a switch of controllers of something else
  }
  // Checked before anything is stopped: a motion that ends here could not start again.
  refused_ = refuses(starts, stops);
  if (refused_) {
    refusal_.store(Refusal::kSingular, std::memory_order_relaxed);
    starts = ControlMode::None;
    if (stops == ControlMode::None) {
      return false;
    }
  }
  stopMotion();
  remaining_ = mode_ & ~stops;
  mode_ = remaining_ | starts;
  connect();
  return true;
}

void SimArm::connect() noexcept {
  waits_ = false;
  ticks_waited_ = 0;
  resetCommands();
  if (mode_ != ControlMode::None) {
    tryToStart();
  }
}

void SimArm::tryToStart() noexcept {
  waits_ = false;
  if (!canConnect()) {
    return;
  }
  franka_core::fci::MoveRequest request;
  request.motion_generator_mode = generatorOf(mode_);
  request.controller_mode = contains(mode_, ControlMode::JointTorque)
                                ? franka_core::ControllerMode::kExternalController
                                : options_.internal_controller;
  const bool continued = generatorOf(remaining_) != MotionGeneratorMode::kNone;
  const auto status =
      continued ? unit_.request(franka_sim::ContinuedMove{request}) : unit_.request(request);
  if (status != franka_sim::Status::kMotionStarted) {
    waits_ = true;
    if (++ticks_waited_ > kMaxStopTime) {
      refuse(Refusal::kNotAtRest);
    }
    return;
  }
  if (unit_.state().robot_mode != RobotMode::kMove) {
    refuse(Refusal::kSingular);
    return;
  }
  remaining_ = mode_;
  resetCommands();
  // Controllers that start in this tick read the start of the new motion, not the end of the old
  // one: a step in the first position would make every rate limiter oscillate.
  updateState();
}

void SimArm::stopMotion() noexcept { unit_.request(franka_core::fci::StopMoveRequest{}); }

// What ran before is connected again.
void SimArm::refuse(Refusal why) noexcept {
  refusal_.store(why, std::memory_order_relaxed);
  refused_ = true;
  waits_ = false;
  if (mode_ != remaining_) {
    mode_ = remaining_;
    connect();
  }
}

// The last commands of a stopped controller must not stay in effect.
void SimArm::resetCommands() noexcept {
  const franka_core::RobotState& state = unit_.state();
  commands_ = ArmCommands();
  commands_.position = state.q_d;
  commands_.pose = state.O_T_EE_c;
  applied_ = target_ = commands_;
  ticks_to_target_ = 1;
}

// --- hands on the robot --------------------------------------------------------------------------

void SimArm::setUserStop(bool pressed) noexcept {
  if (pressed == userStopped()) {
    return;
  }
  unit_.request(franka_sim::UserStop{pressed});
  user_stopped_.store(pressed, std::memory_order_relaxed);
}

bool SimArm::recover() noexcept {
  if (userStopped()) {
    return false;
  }
  const std::optional<franka_sim::Status> refusal =
      unit_.request(franka_core::fci::AutomaticErrorRecoveryRequest{});
  return !refusal || refusal == franka_sim::Status::kSuccess;
}

bool SimArm::recovering() const noexcept {
  return unit_.state().robot_mode == RobotMode::kAutomaticErrorRecovery;
}

bool SimArm::setConnected(bool connected) noexcept {
  if (!connected && mode_ != ControlMode::None) {
    return false;
  }
  unit_.request(franka_sim::FciActivation{connected});
  connected_.store(connected, std::memory_order_relaxed);
  return true;
}

void SimArm::worldWasReset() noexcept {
  // The motion ends here; its controllers start again in the next tick.
  const bool moving = unit_.state().robot_mode == RobotMode::kMove && generates();
  if (moving) {
    stopMotion();
  }
  unit_.restart();
  filter_is_fresh_ = true;
  resetCommands();
  ticks_waited_ = 0;
  waits_ = waits_ || moving;
}

void SimArm::jointsWerePlaced() noexcept {
  stopMotion();
  waits_ = false;
  worldWasReset();
}

}  // namespace franka_sim_mujoco
