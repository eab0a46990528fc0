// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/texts.h>
#include <franka_core/motion_limits.h>
#include <franka_core/robot_error.h>
#include <franka_core/rotations.h>
#include <franka_core/smooth_step.h>
#include <franka_core/tick.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/simulation/simulated_robot.h>

#include <algorithm>

#include "robot/laws/cartesian_impedance.h"
#include "robot/laws/joint_impedance.h"

namespace franka_sim {

using franka_core::kTick;
using franka_core::RobotState;

namespace {

// Initial stiffnesses, chosen here: soft enough to touch things, stiff enough to reach a target.
constexpr std::array<double, 7> kJointSpring{600, 600, 600, 600, 250, 150, 50};  // [Nm/rad]
constexpr std::array<double, 6> kCartesianSpring{2000, 2000, 2000, 100, 100, 100};
constexpr double kNullspaceSpring = 10.0;  // [Nm/rad]

// A client of the robot sees velocities with their noise, the robot itself without.
std::array<double, 7> coriolisOf(const RobotState& state, const ControlUnitParameters& unit,
                                 const franka_core::ArmDynamics& dynamics) noexcept {
  if (unit.sensors.dq_noise == std::array<double, 7>{}) {
    return dynamics.coriolis;
  }
  return unit.model.coriolis(state.q, state.dq, {state.m_total, state.F_x_Ctotal, state.I_total});
}

// Of a motion of this duration, after this time.
double shareOf(double time, double duration, TargetMotion motion) {
  if (duration <= 0.0) {
    return 1.0;
  }
  return motion == TargetMotion::kLinear ? time / duration
                                         : franka_core::smoothStep(time / duration);
}

}  // namespace

JointLaw::JointLaw(const RobotState& state) noexcept
    : stiffness_(kJointSpring), from_(state.q_d), to_(state.q_d), desired_(state.q_d) {}

void JointLaw::setTarget(const std::array<double, 7>& q, double duration,
                         TargetMotion motion) noexcept {
  from_ = desired_;
  to_ = q;
  time_ = 0.0;
  duration_ = duration;
  motion_ = motion;
}

std::array<double, 7> JointLaw::torque(const RobotState& state, const ControlUnitParameters& unit,
                                       const franka_core::ArmDynamics& dynamics) noexcept {
  time_ = std::min(time_ + kTick, duration_);
  const double share = shareOf(time_, duration_, motion_);
  std::array<double, 7> dq_d;
  for (std::size_t i = 0; i < desired_.size(); i++) {
    const double next = from_[i] + share * (to_[i] - from_[i]);
    dq_d[i] = duration_ > 0.0 ? (next - desired_[i]) / kTick : 0.0;
    desired_[i] = next;
  }
  return JointImpedance(stiffness_, unit.rotor_inertia)
      .torque(desired_, dq_d, state.q, state.dq, dynamics.mass, coriolisOf(state, unit, dynamics));
}

CartesianLaw::CartesianLaw(const RobotState& state) noexcept
    : stiffness_(kCartesianSpring),
      nullspace_stiffness_(kNullspaceSpring),
      from_(state.O_T_EE_d),
      to_(state.O_T_EE_d),
      desired_(state.O_T_EE_d),
      q_(state.q_d) {}

void CartesianLaw::setTarget(const std::array<double, 16>& O_T_EE, double duration,
                             TargetMotion motion) noexcept {
  from_ = desired_;
  to_ = O_T_EE;
  time_ = 0.0;
  duration_ = duration;
  motion_ = motion;
}

void CartesianLaw::advance() noexcept {
  time_ = std::min(time_ + kTick, duration_);
  const double share = shareOf(time_, duration_, motion_);
  const Eigen::Map<const Eigen::Matrix4d> from(from_.data()), to(to_.data());
  Eigen::Map<Eigen::Matrix4d> desired(desired_.data());
  const Eigen::Matrix3d turn = from.topLeftCorner<3, 3>().transpose() * to.topLeftCorner<3, 3>();
  desired.topLeftCorner<3, 3>() =
      from.topLeftCorner<3, 3>() * franka_core::rotationFrom(share * franka_core::vectorOf(turn));
  desired.topRightCorner<3, 1>() =
      from.topRightCorner<3, 1>() +
      share * (to.topRightCorner<3, 1>() - from.topRightCorner<3, 1>());
}

std::array<double, 7> CartesianLaw::torque(const RobotState& state,
                                           const ControlUnitParameters& unit,
                                           const franka_core::ArmDynamics& dynamics) noexcept {
  const std::array<double, 16> before = desired_;
  advance();
  CartesianImpedanceInput input{};
  input.O_T_EE_d = desired_;
  input.O_T_EE = state.O_T_EE;
  input.EE_T_K = state.EE_T_K;
  if (duration_ > 0.0) {  // otherwise the target jumps, with no velocity on its way
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(input.O_dP_EE_d.data()) =
        franka_core::twistBetween(Eigen::Map<const Eigen::Matrix4d>(before.data()),
                                  Eigen::Map<const Eigen::Matrix4d>(desired_.data()), kTick);
  }
  input.O_J_EE = dynamics.zero_jacobian;
  input.mass = dynamics.mass;
  input.q_d = q_;
  input.q = state.q;
  input.dq = state.dq;
  input.coriolis = coriolisOf(state, unit, dynamics);
  input.K = stiffness_;
  input.nullspace_stiffness = nullspace_stiffness_;
  input.rotor_inertia = unit.rotor_inertia;
  return cartesianImpedance(input);
}

using franka_core::RobotCommand;
using franka_core::fci::MoveRequest;

namespace {

std::optional<WholeRobot::Hand> handOf(const RobotInWorld& robot, bool driven) {
  return driven && robot.hand != nullptr
             ? std::optional<WholeRobot::Hand>({robot.hand, handParameters(robot.physics.gripper)})
             : std::nullopt;
}

/// What the user has to do before a refused request is possible, or nothing.
std::string remedy(const RobotState& state, const UnitStatus& unit, bool recovery) {
  using franka_core::RobotMode;
  switch (state.robot_mode) {
    case RobotMode::kUserStopped:
      return " Release the user stop first.";
    case RobotMode::kOther:
      return " Its brakes are closed: open them first.";
    case RobotMode::kAutomaticErrorRecovery:
      return " It recovers: step until it is Idle.";
    case RobotMode::kGuiding:
      return " End guiding first.";
    case RobotMode::kMove:
      return " End the motion first.";
    case RobotMode::kReflex:
      return recovery ? " A joint is beyond its limits: guide the arm back first."
                      : " Recover it first.";
    default:
      return unit.settling ? " The arm still brakes: step until it rests." : "";
  }
}

// Operators' requests go to the safety controller, as those of the other interfaces do; nothing for
// other requests.
std::optional<Refusal> operate(SafetyController& safety, const UnitRequest& request) noexcept {
  if (const auto* const stop = std::get_if<UserStop>(&request)) {
    safety.pressUserStop(stop->pressed);
    return Refusal::kNone;
  }
  if (const auto* const guiding = std::get_if<Guiding>(&request)) {
    return safety.guide(guiding->active);
  }
  const auto* const brakes = std::get_if<Brakes>(&request);
  if (brakes != nullptr && brakes->closed) {
    safety.lock();
    return Refusal::kNone;
  }
  return brakes != nullptr ? std::optional(safety.unlock()) : std::nullopt;
}

constexpr double kShareOfLimit = 0.999;  // chosen here: rounding must not exceed the limit

// Steps of a target or a stiffness become steps of the torque, which the robot would refuse.
void limitRate(const std::array<double, 7>& before, const std::array<double, 7>& highest_rate,
               std::array<double, 7>& tau) noexcept {
  for (std::size_t i = 0; i < tau.size(); i++) {
    const double step = kShareOfLimit * highest_rate[i] * franka_core::kTick;
    tau[i] = std::clamp(tau[i], before[i] - step, before[i] + step);
  }
}

}  // namespace

SimulatedRobot::SimulatedRobot(const RobotSetup& setup, bool hand, World& world)
    : SimulatedRobot(setup, hand, addRobot(setup, kInProcessProfile, world, hand)) {}

SimulatedRobot::SimulatedRobot(const RobotSetup& setup, bool hand, const RobotInWorld& in_world)
    : setup_(setup),
      robot_(in_world.unit, *in_world.arm, handOf(in_world, hand), {},
             in_world.physics.command_delay) {}

void SimulatedRobot::refuse(const std::string& what, bool recovery) const {
  std::string errors;
  for (std::size_t i = 0; i < state_.errors.size(); i++) {
    if (state_.errors[i]) {
      errors += (errors.empty() ? ": " : ", ") + std::string(franka_core::kErrorNames[i]);
    }
  }
  throw RequestRefused(what + " was refused: the robot is in mode " +
                       franka_core::fci::modeName(state_.robot_mode) + errors + "." +
                       remedy(state_, robot_.unit().status(), recovery));
}

void SimulatedRobot::start(const MoveRequest& motion) {
  if (moving() && (motion.controller_mode != motion_.controller_mode ||
                   motion.motion_generator_mode != motion_.motion_generator_mode)) {
    throw RequestRefused("A motion of another kind runs; end it first.");
  }
  if (moving() && finishing_) {
    throw RequestRefused("The motion is ending; step until it has ended, then command again.");
  }
  if (moving()) {
    return;
  }
  const std::optional<Status> status = robot_.unit().request(motion);
  if (status == Status::kInvalidArgumentRejected) {
    throw RequestRefused("The motion was refused: its controller cannot drive this generator.");
  }
  if (status != Status::kMotionStarted) {
    refuse("The motion");
  }
  refresh();
  motion_ = motion;
  shaping_ = {};
  finishing_ = false;
}

void SimulatedRobot::command(const MoveRequest& motion, const RobotCommand& command) {
  start(motion);
  input_ = command;
  shaping_ = {};
}

// Before version 10, clients send velocities of zero along with torques.
MoveRequest SimulatedRobot::torqueMotion() const noexcept {
  MoveRequest motion = torqueControl();
  if (robot_.unit().configuration().protocol_version < 10) {
    motion.motion_generator_mode = franka_core::MotionGeneratorMode::kJointVelocity;
  }
  return motion;
}

void SimulatedRobot::commandTorques(const std::array<double, 7>& tau,
                                    const TorqueShaping& shaping) {
  RobotCommand torques;
  torques.tau_J_d = tau;
  command(torqueMotion(), torques);
  shaping_ = shaping;
}

template <typename Law>
Law& SimulatedRobot::law() {
  start(torqueMotion());
  if (!std::holds_alternative<Law>(input_)) {
    input_.emplace<Law>(state());
  }
  return std::get<Law>(input_);
}

JointLaw& SimulatedRobot::jointLaw() { return law<JointLaw>(); }
CartesianLaw& SimulatedRobot::cartesianLaw() { return law<CartesianLaw>(); }

void SimulatedRobot::finish() noexcept { finishing_ = moving(); }

void SimulatedRobot::request(const UnitRequest& request, const std::string& what) {
  if (const std::optional<Refusal> refusal = operate(robot_.safety(), request)) {
    if (refusal == Refusal::kSelfTestRunning || refusal == Refusal::kNotReady) {
      throw RequestRefused(what + " was refused. " + std::string(sentenceOf(*refusal)));
    }
    if (refusal != Refusal::kNone) {
      refuse(what);
    }
    refresh();
    return;
  }
  const std::optional<Status> status = robot_.unit().request(request);
  if (status == Status::kInvalidArgumentRejected) {
    throw RequestRefused(what + " was refused: a value is outside of what the robot accepts.");
  }
  if (status && status != Status::kSuccess) {
    refuse(what);
  }
  refresh();
}

void SimulatedRobot::recover() {
  const std::optional<Status> status =
      robot_.unit().request(franka_core::fci::AutomaticErrorRecoveryRequest{});
  if (status && status != Status::kSuccess) {
    refuse("The recovery", true);
  }
  recovering_ = !status;
  refresh();
}

void SimulatedRobot::observe() noexcept {
  robot_.observe();
  // Other answers are for a client on the network.
  if (moving()) {
    if (const std::optional<Status> end = robot_.unit().takeAnswer(PendingAnswer::kMotion)) {
      last_result_ = end;
      input_ = std::monostate{};
    }
  }
  if (recovering_) {
    recovering_ = !robot_.unit().takeAnswer(PendingAnswer::kRecovery);
  }
  refresh();
}

const RobotCommand* SimulatedRobot::nextCommand() noexcept {
  const auto* command = std::get_if<RobotCommand>(&input_);
  if (command != nullptr) {
    sent_ = *command;
  } else {
    sent_ = {};
    const ControlUnitParameters& unit = robot_.unit().configuration();
    const franka_core::ArmDynamics& dynamics = robot_.unit().dynamics();
    auto* joint_law = std::get_if<JointLaw>(&input_);
    sent_.tau_J_d = joint_law != nullptr
                        ? joint_law->torque(state_, unit, dynamics)
                        : std::get<CartesianLaw>(input_).torque(state_, unit, dynamics);
  }
  for (std::size_t i = 0; i < sent_.tau_J_d.size(); i++) {
    sent_.tau_J_d[i] -= shaping_.damping[i] * state_.dq[i];
  }
  if (command == nullptr || shaping_.limit_rate) {
    limitRate(state_.tau_J_d, robot_.unit().limits().arm.dtau, sent_.tau_J_d);
  }
  sent_.message_id = state_.message_id;
  sent_.motion_generation_finished = finishing_;
  sent_.torque_command_finished = finishing_;
  return &sent_;
}

void SimulatedRobot::actuate(const RobotCommand* command) noexcept {
  robot_.actuate(moving() ? nextCommand() : command);
}

bool SimulatedRobot::hasSameSetup(const SimulatedRobot& other) const {
  const RobotSetup& one = setup_;
  const RobotSetup& two = other.setup_;
  return one.robot == two.robot && one.arm_id == two.arm_id &&
         (robot_.hand() == nullptr) == (other.robot_.hand() == nullptr) &&
         haveSameBehavior(readRealism(one.realism, kInProcessProfile),
                          readRealism(two.realism, kInProcessProfile));
}

void SimulatedRobot::restore(const SimulatedRobot& then, bool earlier) {
  if (served_) {
    restart();
    observe();
    return;
  }
  const RobotSetup own = setup_;
  *this = then;
  setup_ = own;
  served_ = false;
  if (!earlier && robot_.hand() != nullptr) {
    robot_.hand()->renumberTickets();
  }
}

// Without a generator it would continue, and lack commands. Clients are not answered for it.
void SimulatedRobot::endOwnMotion() noexcept {
  if (moving()) {
    robot_.unit().request(franka_core::fci::StopMoveRequest{});
    robot_.unit().restart();
    robot_.unit().takeAnswer(PendingAnswer::kMotion);
    robot_.unit().takeAnswer(PendingAnswer::kStop);
  }
}

void SimulatedRobot::restart() {
  if (served_) {
    endOwnMotion();
    robot_.restart();
  } else {
    robot_.renew();
  }
  recovering_ = false;
  input_ = std::monostate{};
  finishing_ = false;
}

}  // namespace franka_sim
