// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/texts.h>
#include <franka_core/robot_error.h>
#include <franka_core/tick.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/simulation/simulated_robot.h>

#include <algorithm>

namespace franka_sim {

using franka_core::RobotCommand;
using franka_core::fci::MoveRequest;

namespace {

std::optional<WholeRobot::Hand> handOf(const RobotInWorld& robot, bool driven) {
  return driven && robot.hand != nullptr
             ? std::optional<WholeRobot::Hand>({robot.hand, handParameters(robot.physics.gripper)})
             : std::nullopt;
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

void SimulatedRobot::refuse(const std::string& what) const {
  std::string errors;
  for (std::size_t i = 0; i < state_.errors.size(); i++) {
    if (state_.errors[i]) {
      errors += (errors.empty() ? ": " : ", ") + std::string(franka_core::kErrorNames[i]);
    }
  }
  throw RequestRefused(what + " was refused: the robot is in mode " +
                       franka_core::fci::modeName(state_.robot_mode) + errors + "." +
                       (errors.empty() ? "" : " Recover it first."));
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
    refuse("The recovery");
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
