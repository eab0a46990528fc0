// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "properties/stepped_robot.h"

#include <franka_core/fci/commands.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <rt_guard/rt_guard.h>
#include <source_file.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "panda_arm.h"

namespace franka_sim::test {

namespace {

namespace codec = franka_core::fci;
using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotMode;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 7> kElsewhere{{0.5, 0.1, -0.5, -2, 0.3, 1.8, 0.2}};
constexpr unsigned kLegal = 10;  // variants of setters below this one are legal

const franka_core::ArmModel& modelOf(const Setting& setting) {
  static const franka_core::ArmModel panda = pandaModel();
  static const franka_core::ArmModel fr3 =
      franka_core::ArmModel::fromUrdf(franka_test::readSource("franka_sim/robots/fr3.urdf"), "fr3");
  return setting.isFr3() ? fr3 : panda;
}

ControlUnitParameters parametersOf(const Setting& setting) {
  ControlUnitParameters parameters{modelOf(setting)};
  parameters.end_effector = pandaHand();
  parameters.F_T_NE = kHandF_T_NE;
  parameters.protocol_version = setting.version;
  parameters.rules = setting.rules;
  if (setting.noise) {
    parameters.sensors.tau_J_resolution.fill(0.01);
    parameters.sensors.tau_J_noise.fill(0.05);
    parameters.sensors.dq_noise.fill(0.001);
    parameters.sensors.tau_J_ripple.fill(0.1);
    parameters.sensors.ripple_frequency.fill(25.0);
  }
  return parameters;
}

WholeRobot::Hand handOf(const Setting& setting, FakeHand& hand) {
  return {&hand, handParameters({setting.hand_latency, setting.hand_latency})};
}

/// Sets one number of a request to a wrong value, for illegal variants.
template <std::size_t N>
void spoil(const std::array<std::pair<double*, double>, N>& faults, unsigned variant) {
  if (variant >= kLegal) {
    const auto& [number, wrong] = faults[std::min<std::size_t>(variant - kLegal, N - 1)];
    *number = wrong;
  }
}

franka_core::Payload payloadOf(unsigned variant) {
  franka_core::Payload payload;
  payload.mass = 0.1 * (variant % kLegal);
  payload.com = {{0, 0, 0.05}};
  payload.inertia = {{1e-3, 0, 0, 0, 1e-3, 0, 0, 0, 1e-3}};
  auto& inertia = payload.inertia;
  spoil<13>({{{&payload.mass, kNaN},
              {&payload.mass, -1.0},
              {&payload.mass, 10.1},
              {&payload.com[1], kNaN},
              {&payload.com[0], 1.1},
              {&inertia[4], kNaN},
              {&inertia[1], 0.1},
              {&inertia[0], -1e-3},
              {&inertia[8], 10.1},
              {&payload.com[2], -1e11},
              {&inertia[4], kInfinity},
              {&payload.mass, 1e300},
              {&payload.mass, kInfinity}}},
            variant);
  return payload;
}

std::array<double, 16> frameOf(unsigned variant) {
  std::array<double, 16> frame = franka_core::kIdentityTransform;
  frame[14] = 0.01 * (variant % kLegal);
  spoil<9>({{{&frame[0], kNaN},
             {&frame[5], 0.0},
             {&frame[10], 1.1},
             {&frame[3], 0.5},
             {&frame[12], 10.1},
             {&frame[10], -1.0},
             {&frame[13], kInfinity},
             {&frame[14], -1e11},
             {&frame[14], kNaN}}},
           variant);
  return frame;
}

/// One of N values beyond a range, for illegal variants.
template <std::size_t N>
std::array<double, N> spoiled(std::array<double, N> values, unsigned variant, double lowest,
                              double highest) {
  if (variant >= kLegal) {
    const std::array<double, 4> wrong{kNaN, lowest, highest, -kInfinity};
    values[variant % N] = wrong[variant % wrong.size()];
  }
  return values;
}

codec::SetCollisionBehaviorRequest thresholdsOf(unsigned variant) {
  CollisionThresholds thresholds;
  thresholds.lower_torque.fill(10.0 + variant);
  thresholds.upper_torque.fill(20.0 + variant);
  thresholds.lower_force.fill(10.0 + variant);
  thresholds.upper_force.fill(20.0 + variant);
  codec::SetCollisionBehaviorRequest request = collisionRequest(thresholds, thresholds);
  if (variant < kLegal) {
    return request;
  }
  const double wrong = variant % 2 == 0 ? kNaN : -1.0;
  switch (variant % 4) {
    case 0:
      request.lower_torques_acceleration[variant % 7] = wrong;
      break;
    case 1:
      request.upper_torques_nominal[variant % 7] = wrong;
      break;
    case 2:
      request.lower_forces_nominal[variant % 6] = wrong;
      break;
    default:
      request.upper_forces_acceleration[variant % 6] = kInfinity;
  }
  return request;
}

codec::SetFiltersRequest filtersOf(unsigned variant) {
  const double good = 100.0 * (1 + variant % kLegal);
  std::array<double, 5> cutoffs{good, good, good, good, good};
  cutoffs = spoiled(cutoffs, variant, 0.5, 1001.0);
  return {cutoffs[0], cutoffs[1], cutoffs[2], cutoffs[3], cutoffs[4]};
}

SetVirtualWall wallOf(unsigned variant) {
  SetVirtualWall request{static_cast<std::int32_t>(variant % 8), {}};
  request.wall.object_frame = frameOf(variant % kLegal);
  request.wall.object_frame[12] = 3.0;  // out of the arm's reach
  request.wall.object_world_size.fill(0.1);
  request.wall.active = variant % 2 == 0;
  if (variant >= kLegal) {
    const bool wrong_id = variant % 3 == 0;
    const bool wrong_size = variant % 3 == 1;
    request.id = wrong_id ? (variant % 2 == 0 ? -1 : 8) : request.id;
    request.wall.object_world_size[1] = wrong_size ? (variant % 2 == 0 ? -0.1 : kNaN) : 0.1;
    if (!wrong_id && !wrong_size) {
      request.wall.object_frame[5] = 2.0;
    }
  }
  return request;
}

/// A request, and whether a robot that is ready must refuse it.
struct Motion {
  codec::MoveRequest request;
  bool legal{true};
};

Motion motionOf(unsigned variant) {
  constexpr std::array<MotionGeneratorMode, 5> kGenerators{
      MotionGeneratorMode::kJointPosition, MotionGeneratorMode::kJointVelocity,
      MotionGeneratorMode::kCartesianPosition, MotionGeneratorMode::kCartesianVelocity,
      MotionGeneratorMode::kNone};
  constexpr std::array<ControllerMode, 3> kControllers{ControllerMode::kJointImpedance,
                                                       ControllerMode::kCartesianImpedance,
                                                       ControllerMode::kExternalController};
  Motion motion;
  codec::MoveRequest& request = motion.request;
  request.motion_generator_mode = kGenerators[variant % 5];
  request.controller_mode = kControllers[variant / 5 % 3];
  request.maximum_velocity.fill(0.5);
  motion.legal = request.motion_generator_mode != MotionGeneratorMode::kNone ||
                 request.controller_mode == ControllerMode::kExternalController;
  if (variant < 15) {
    return motion;
  }
  request.motion_generator_mode = kGenerators[0];
  request.controller_mode = kControllers[0];
  motion.legal = variant <= 17;
  request.use_async_motion_generator = variant >= 16 && variant <= 20;
  if (variant == 18) {
    request.maximum_velocity[2] = 0.0;
  } else if (variant == 19) {
    request.maximum_velocity[6] = kNaN;
  } else if (variant == 20) {
    request.motion_generator_mode = kGenerators[3];
  } else if (variant == 21) {
    request.motion_generator_mode = MotionGeneratorMode::kIdle;
  } else if (variant == 22) {
    request.controller_mode = ControllerMode::kOther;
  } else if (variant == 23) {
    request.max_path_deviation.translation = kNaN;
  } else if (variant == 24) {
    request.max_goal_deviation.rotation = 0.0;
  } else if (variant == 25) {
    request.max_path_deviation.elbow = -1.0;
  }
  return motion;
}

}  // namespace

rc::Gen<Setting> settings() {
  using Rules = InterfaceRules;
  using Safety = SafetyRules;
  static const std::array<Setting, 12> kSettings{
      {{"Panda, FCI", 5, Rules::kFci, Safety::kOpen, true},
       {"FR3, FCI", 10, Rules::kFci, Safety::kOpen, true},
       {"Panda, ros_control", 5, Rules::kRosControl, Safety::kOpen, true},
       {"FR3, ros_control", 10, Rules::kRosControl, Safety::kOpen, true},
       {"Panda, ros_control with reflexes", 5, Rules::kRosControlWithReflexes, Safety::kOpen, true},
       {"Panda, Desk", 5, Rules::kFci, Safety::kDesk, true},
       {"FR3, Desk", 10, Rules::kFci, Safety::kDesk, true},
       {"Panda of 2018, Desk, locked", 3, Rules::kFci, Safety::kDesk, false},
       {"FR3 of 2022, Desk, locked", 7, Rules::kFci, Safety::kDesk, false},
       {"FR3 of 2022, FCI, noise", 7, Rules::kFci, Safety::kOpen, true, true},
       {"Panda, FCI, noise and delays", 5, Rules::kFci, Safety::kOpen, true, true, 2, 0.005},
       {"FR3, ros_control with reflexes, noise", 10, Rules::kRosControlWithReflexes, Safety::kOpen,
        true, true, 0, 0.005}}};
  return rc::gen::map(below(kSettings.size()), [](std::size_t i) { return kSettings[i]; });
}

SteppedRobot::SteppedRobot(const Setting& setting)
    : setting_(setting),
      arm_(kReady),
      robot_(parametersOf(setting), arm_, handOf(setting, hand_), {}, setting.delay),
      commands_(2) {
  SafetyController& safety = robot_.safety();
  safety.setBrakeTime(0.007);
  safety.setSelfTestTime(0.01);
  robot_.start(setting.safety);
  run(2);
  if (setting.unlocked && setting.safety == SafetyRules::kDesk) {
    safety.unlock();
    run(8);
    if (!setting.isFr3()) {
      press(SafetyInput::kX4, false);
    }
    safety.activateFci();
  }
}

void SteppedRobot::takeOver(const SteppedRobot& other) {
  arm_ = other.arm_;
  hand_ = other.hand_;
  robot_ = other.robot_;
  operator_stop_ = other.operator_stop_;
  inputs_ = other.inputs_;
  commands_ = other.commands_;
  motion_ticks_ = other.motion_ticks_;
  start_ = other.start_;
  answers_ = other.answers_;
}

void SteppedRobot::place() {
  arm_.put(kReady);
  robot_.restart();
}

// --- time ----------------------------------------------------------------------------------------

void SteppedRobot::tick() {
  {
    const rt_guard::Scope scope;
    robot_.observe();
    robot_.actuate(nextCommand());
    for (std::size_t i = 0; i < answers_.size(); i++) {
      answers_[i] = robot_.unit().takeAnswer(static_cast<PendingAnswer>(i));
    }
    real_time_faults_ += scope.allocations() + scope.locks();
  }
  arm_.step(robot_.unit().dynamics());
  hand_.step();
  trace_.add(state());
  trace_.add(arm_.torques());
  for (const std::optional<Status>& answer : answers_) {
    trace_.add(answer.has_value());
  }
}

void SteppedRobot::run(unsigned ticks) {
  for (unsigned i = 0; i < ticks; i++) {
    tick();
  }
}

// The client's plan is a small oscillation of all joints and of the end effector along y.
const franka_core::RobotCommand* SteppedRobot::nextCommand() {
  if (state().robot_mode != RobotMode::kMove || commands_ == 0 ||
      (commands_ == 8 && motion_ticks_ % 2 == 0)) {
    return nullptr;
  }
  const double amplitude = commands_ == 3 ? 0.025 : 0.01;
  const double phase = commands_ == 1 ? 0.0 : 0.01 * motion_ticks_;
  const double way = amplitude * (1.0 - std::cos(phase));
  const double velocity = 10.0 * amplitude * std::sin(phase);
  motion_ticks_++;
  command_ = {};
  for (std::size_t i = 0; i < 7; i++) {
    command_.q_c[i] = start_.q_d[i] + way;
    command_.dq_c[i] = velocity;
    command_.tau_J_d[i] = velocity;
  }
  command_.O_T_EE_c = start_.O_T_EE_c;
  command_.O_T_EE_c[13] += way;
  command_.O_dP_EE_c[1] = velocity;
  switch (commands_) {
    case 4:
      command_.motion_generation_finished = true;
      command_.torque_command_finished = true;
      break;
    case 5:
      command_.q_c[2] += 0.1;
      command_.dq_c[2] += 3.0;
      command_.O_T_EE_c[12] += 0.1;
      command_.O_dP_EE_c[0] += 3.0;
      command_.tau_J_d[2] += 5.0;
      break;
    case 6:
      command_.q_c[4] = command_.dq_c[4] = command_.O_T_EE_c[12] = command_.O_dP_EE_c[5] = kNaN;
      break;
    case 7:  // accelerates the last joint until its velocity is too high
      command_.tau_J_d[6] = std::min(0.9 * motion_ticks_, 11.0);
      command_.dq_c[6] = 0.015 * motion_ticks_;
      break;
    case 9:
      command_.valid_elbow = true;
      command_.elbow_c = {{1.0, 0.0}};
      break;
    case 10:
      command_.O_T_EE_c[0] *= 2.0;
      break;
    case 11:
      command_.tau_J_d[5] = -kInfinity;
      break;
    default:
      break;
  }
  return &command_;
}

// --- actions -------------------------------------------------------------------------------------

SteppedRobot::Answer SteppedRobot::act(const Step& step) {
  const rt_guard::Scope scope;
  const Answer answer = step.action < Action::kUserStop  ? client(step)
                        : step.action < Action::kSetLoad ? operate(step)
                                                         : configure(step);
  // A new control unit is made when the power is switched on.
  real_time_faults_ += step.action == Action::kPower ? 0 : scope.allocations() + scope.locks();
  return answer;
}

SteppedRobot::Answer SteppedRobot::request(const UnitRequest& request, bool legal) {
  const std::optional<Status> status = robot_.unit().request(request);
  const bool done = !status || status == Status::kSuccess || status == Status::kMotionStarted;
  return !done ? Answer::kRefused : legal ? Answer::kDone : Answer::kIllegalAccepted;
}

SteppedRobot::Answer SteppedRobot::client(const Step& step) {
  switch (step.action) {
    case Action::kSend:
      commands_ = step.variant % 12;
      break;
    case Action::kMove: {
      const Motion motion = motionOf(step.variant);
      const franka_core::RobotState before = state();
      const Answer answer = request(motion.request, motion.legal);
      if (answer == Answer::kDone) {
        motion_ticks_ = 0;
        start_ = before;
      }
      return answer;
    }
    case Action::kStopMove:
      return request(codec::StopMoveRequest{});
    case Action::kRecover:
      return request(codec::AutomaticErrorRecoveryRequest{});
    case Action::kClientLost:
      return request(ClientLost{});
    case Action::kLoseCommands:
      robot_.link().loseNext(step.variant);
      break;
    default:
      break;
  }
  return Answer::kDone;
}

void SteppedRobot::press(SafetyInput input, bool pressed) {
  inputs_[static_cast<std::size_t>(input)] = pressed;
  robot_.safety().press(input, pressed);
}

void SteppedRobot::pressUserStop(bool pressed) {
  operator_stop_ = pressed;
  robot_.safety().pressUserStop(pressed);
}

bool SteppedRobot::stopPressed() const {
  const auto is_pressed = [this](SafetyInput input) {
    return inputs_[static_cast<std::size_t>(input)];
  };
  const bool wired = setting_.isFr3()
                         ? is_pressed(SafetyInput::kX31) || is_pressed(SafetyInput::kX32) ||
                               is_pressed(SafetyInput::kX33)
                         : is_pressed(SafetyInput::kX4);
  return operator_stop_ || wired;
}

SteppedRobot::Answer SteppedRobot::operate(const Step& step) {
  SafetyController& safety = robot_.safety();
  const unsigned v = step.variant;
  const bool on = v % 2 == 0;
  Refusal refusal = Refusal::kNone;
  switch (step.action) {
    case Action::kUserStop:
      pressUserStop(on);
      break;
    case Action::kInput:
      press(static_cast<SafetyInput>(v / 2 % 4), on);
      break;
    case Action::kUnlock:
      refusal = safety.unlock();
      break;
    case Action::kLock:
      safety.lock();
      break;
    case Action::kFci:
      if (on) {
        refusal = safety.activateFci();
      } else {
        safety.deactivateFci();
      }
      break;
    case Action::kOperatingMode:
      refusal = setting_.isFr3() ? safety.setOperatingMode(on ? OperatingMode::kProgramming
                                                              : OperatingMode::kExecution)
                                 : Refusal::kNone;
      break;
    case Action::kGuide:
      safety.guide(on);  // a refused one still is a button that is pressed
      break;
    case Action::kGuidingMode:
      refusal = safety.setGuidingMode(static_cast<GuidingMode>(v % 4), {on, !on, on, !on, on, on});
      break;
    case Action::kSelfTest:
      if (v < 20) {
        refusal = safety.startSelfTest();
      } else {
        safety.setSelfTestDue(0.005);
      }
      break;
    case Action::kInject:
      if (v < 20) {
        safety.inject(static_cast<RecoverableError>(v / 2), on);
      } else {
        safety.inject(static_cast<DemandedRecovery>(v % 2), v % 7, true);
      }
      break;
    case Action::kAcknowledge:
      refusal = v < 20 ? safety.acknowledge(static_cast<RecoverableError>(v / 2))
                       : safety.acknowledge(static_cast<DemandedRecovery>(v % 2));
      break;
    case Action::kPower:
      robot_.setPower(on);
      break;
    default:
      return moveByOperator(v);
  }
  return refusal == Refusal::kNone ? Answer::kDone : Answer::kRefused;
}

SteppedRobot::Answer SteppedRobot::moveByOperator(unsigned variant) {
  if (variant >= 20) {
    robot_.operatorMotion().stop();
    return Answer::kDone;
  }
  if (robot_.safety().allowsOperatorMotion() != Refusal::kNone) {
    return Answer::kRefused;
  }
  std::array<double, 7> q = state().q_d;
  double speed = 0.5;
  q[variant % 7] += variant < kLegal ? 0.02 : 0.0;
  if (variant == 10) {
    q[3] = 10.0;
  } else if (variant == 11) {
    q[0] = kNaN;
  } else if (variant >= kLegal) {
    speed = variant % 3 == 0 ? kNaN : variant % 3 == 1 ? 0.0 : 1.5;
  }
  const Status status = robot_.operatorMotion().start(q, speed);
  return status != Status::kMotionStarted ? Answer::kRefused
         : variant < kLegal               ? Answer::kDone
                                          : Answer::kIllegalAccepted;
}

SteppedRobot::Answer SteppedRobot::configure(const Step& step) {
  const unsigned v = step.variant;
  const bool legal = v < kLegal;
  std::array<double, 7> K_theta;
  std::array<double, 6> K_x;
  K_theta.fill(100.0 * (1 + v));
  K_x.fill(10.0 * (1 + v));
  switch (step.action) {
    case Action::kSetLoad:
      return request(loadRequest(payloadOf(v)), legal);
    case Action::kSetEndEffector:  // payload and frame: one of them is wrong
      return request(SetEndEffector{payloadOf(v % 2 == 0 ? v : v % kLegal),
                                    frameOf(v % 2 == 0 ? v % kLegal : v)},
                     legal);
    case Action::kSetNEToEE:
      return request(codec::SetNEToEERequest{frameOf(v)}, legal);
    case Action::kSetEEToK:
      return request(codec::SetEEToKRequest{frameOf(v)}, legal);
    case Action::kSetCollisionBehavior:
      return request(thresholdsOf(v), legal);
    case Action::kSetJointImpedance:
      return request(codec::SetJointImpedanceRequest{spoiled(K_theta, v, -1.0, 14251.0)}, legal);
    case Action::kSetCartesianImpedance:
      return request(codec::SetCartesianImpedanceRequest{spoiled(K_x, v, 0.5, 3001.0)}, legal);
    case Action::kSetFilters:
      return request(filtersOf(v), legal);
    case Action::kSetVirtualWall:
      return request(wallOf(v), legal);
    case Action::kSetProtocolVersion: {
      constexpr std::array<unsigned, 4> kUnknown{2, 11, 0, 4000000000U};
      const unsigned own = setting_.isFr3() ? 6 + v % 5 : 3 + v % 3;
      return request(SetProtocolVersion{legal ? own : kUnknown[v % 4]}, legal);
    }
    case Action::kHand:
      return commandHand(v);
    case Action::kSpoilMeasurement:
      arm_.spoilMeasurement();
      break;
    case Action::kPush: {
      std::array<double, 7> push{};
      push[v % 7] = 2.0 * (v < 20 ? v : 0);
      arm_.setPush(push);
      break;
    }
    default:
      arm_.put(v % 2 == 0 ? state().q : kElsewhere);
      robot_.restart();
  }
  return Answer::kDone;
}

SteppedRobot::Answer SteppedRobot::commandHand(unsigned variant) {
  GripperUnit& hand = *robot_.hand();
  const bool legal = variant < 20;
  GripperUnit::Ticket ticket = 0;
  switch (variant) {
    case 20:
      ticket = hand.move(-0.01, 0.1);
      break;
    case 21:
      ticket = hand.move(kNaN, 0.1);
      break;
    case 22:
      ticket = hand.move(0.081, 0.1);
      break;
    case 23:
      ticket = hand.move(0.04, -1.0);
      break;
    case 24:
      ticket = hand.grasp(0.04, 0.01, 0.01, 0.1, kNaN);
      break;
    case 25:
      ticket = hand.grasp(0.04, kInfinity, 0.01, 0.1, 10.0);
      break;
    default:
      ticket = variant < 10   ? hand.move(0.008 * variant, 0.1)
               : variant < 14 ? hand.grasp(0.0, 0.005, 0.08, 0.1, 10.0 * variant)
               : variant < 17 ? hand.homing()
                              : hand.stop();
  }
  return ticket == 0 ? Answer::kRefused : legal ? Answer::kDone : Answer::kIllegalAccepted;
}

}  // namespace franka_sim::test
