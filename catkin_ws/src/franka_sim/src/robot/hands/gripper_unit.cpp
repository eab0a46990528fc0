// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/hands/gripper_unit.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "robot/hands/parameter_check.h"

namespace franka_sim {

namespace {

// Force laws of the fingers: gains of the original's FrankaGripperSim (decision 29).
constexpr FingerGains kFingerGains{100.0, 0.0, 1.0};

constexpr double kForceRise = 0.05;  // [s] until a grasp reaches its full force (chosen here)
/// Allowed lead of the desired width [m]; beyond it, fingers at standstill mean an obstacle (chosen
/// here: free fingers follow much earlier).
constexpr double kMaxLead = 1e-3;
constexpr double kMinSpeed = 1e-5;  // [m/s]: slower counts as standing still (chosen here)
constexpr double kPressingDamping =
    20.0;  // [N s/m] at most: stable at 1 kHz for fingers from 0.015 kg on

bool isPositive(double value) noexcept { return std::isfinite(value) && value > 0.0; }
bool isNotNegative(double value) noexcept { return std::isfinite(value) && value >= 0.0; }

bool isFinite(const HandMeasurement& m) noexcept {
  return std::isfinite(m.q[0]) && std::isfinite(m.q[1]) && std::isfinite(m.dq[0]) &&
         std::isfinite(m.dq[1]);
}

const GripperParameters& checked(const GripperParameters& parameters) {
  const auto require = [](bool condition, const char* name, const char* must) {
    requireOf("gripper", condition, name, must);
  };
  for (std::size_t i = 0; i < 2; i++) {
    const FingerGains& gains = parameters.gains[i];
    require(isNotNegative(gains.p) && isNotNegative(gains.i) && isNotNegative(gains.d),
            i == 0 ? "finger1/gains" : "finger2/gains", "finite numbers that are not negative");
  }
  require(isPositive(parameters.max_width), "max_width", "a positive width in meters");
  require(isNotNegative(parameters.move_tolerance), "move/width_tolerance",
          "a width in meters that is not negative");
  require(isNotNegative(parameters.resting_threshold), "grasp/resting_threshold",
          "a speed in meters per second that is not negative");
  require(parameters.consecutive_samples >= 1, "grasp/consecutive_samples", "1 or more");
  require(isPositive(parameters.homing_speed), "homing_speed",
          "a positive speed in meters per second");
  require(isPositive(parameters.max_speed), "max_speed", "a positive speed in meters per second");
  require(isPositive(parameters.max_force), "max_force", "a positive force in newtons");
  require(std::isfinite(parameters.room_temperature), "room_temperature",
          "a finite temperature in degrees Celsius");
  require(isNotNegative(parameters.temperature_rise), "temperature_rise",
          "a number of kelvins that is not negative");
  require(isNotNegative(parameters.latency.start) && isNotNegative(parameters.latency.shortest),
          "latency", "two times in seconds that are not negative");
  require(isPositive(parameters.temperature_time), "temperature_time",
          "a positive time in seconds");
  return parameters;
}

}  // namespace

GripperParameters handParameters(const GripperLatency& latency) {
  GripperParameters parameters;
  parameters.gains = {kFingerGains, kFingerGains};
  parameters.latency = latency;
  return parameters;
}

GripperUnit::GripperUnit(const GripperParameters& parameters)
    : parameters_(checked(parameters)),
      temperature_(parameters.room_temperature),
      standstill_(parameters.consecutive_samples),
      fingers_{FingerForce(parameters.gains[0]), FingerForce(parameters.gains[1])} {}

// --- commands ------------------------------------------------------------------------------------

GripperUnit::Ticket GripperUnit::homing() noexcept {
  return accept({Command::Kind::kHoming, 0.0, parameters_.homing_speed, {}});
}

GripperUnit::Ticket GripperUnit::move(double width, double speed) noexcept {
  if (!homed_ || !isNotNegative(width) || width > parameters_.max_width || !isNotNegative(speed)) {
    return 0;
  }
  return accept({Command::Kind::kMove, width, speed, {}});
}

GripperUnit::Ticket GripperUnit::grasp(double width, double epsilon_inner, double epsilon_outer,
                                       double speed, double force) noexcept {
  if (!homed_ || !isNotNegative(width) || width > parameters_.max_width || !isNotNegative(speed) ||
      !isNotNegative(force) || !std::isfinite(epsilon_inner) || !std::isfinite(epsilon_outer)) {
    return 0;
  }
  const double finger_force = 0.5 * std::min(force, parameters_.max_force);
  const double finger_speed = 0.5 * std::min(speed, parameters_.max_speed);
  Command command{Command::Kind::kGrasp, 0.0, speed, {}};
  command.grasp.low = width - epsilon_inner;
  command.grasp.high = width + epsilon_outer;
  command.grasp.force = finger_force;
  // Balances the force at the speed of the grasp, as far as a 1 kHz loop can.
  command.grasp.damping = finger_force < kPressingDamping * finger_speed
                              ? std::max(finger_force / finger_speed, FingerForce::kDriveDamping)
                              : kPressingDamping;
  return accept(command);
}

GripperUnit::Ticket GripperUnit::accept(const Command& command) noexcept {
  const Ticket ticket = tickets_.open();
  since_ = 0.0;
  if (parameters_.latency.start <= 0.0) {
    execute(command);
    return ticket;
  }
  if (state_ != GripperState::kHolding) {
    state_ = GripperState::kIdle;
    drive(0.0, 0.0);
  }
  next_ = command;
  return ticket;
}

void GripperUnit::execute(Command command) noexcept {  // by value: it may be next_
  next_.kind = Command::Kind::kNone;
  drive(command.width, command.speed);
  state_ = GripperState::kMoving;
  homing_ = command.kind == Command::Kind::kHoming ? Homing::kCloses : Homing::kNone;
  if (command.kind == Command::Kind::kGrasp) {
    state_ = GripperState::kGrasping;
    grasp_ = command.grasp;
  }
}

GripperUnit::Ticket GripperUnit::stop() noexcept {
  const Ticket ticket = tickets_.open();
  idle(GripperOutcome::kSucceeded);
  return ticket;
}

void GripperUnit::restart() noexcept {
  idle(GripperOutcome::kInterrupted);
  temperature_ = parameters_.room_temperature;
}

bool GripperUnit::isGrasped() const noexcept {
  return state_ == GripperState::kHolding && withinGrasp();
}

bool GripperUnit::withinGrasp() const noexcept {
  return width() > grasp_.low && width() < grasp_.high;
}

void GripperUnit::drive(double target, double speed) noexcept {
  target_ = target;
  speed_ = std::min(speed, parameters_.max_speed);
  begun_ = false;
  homing_ = Homing::kNone;
  pressing_ = false;
}

// Commands may come before the first measurement; the start width is known only in a step.
void GripperUnit::begin() noexcept {
  begun_ = true;
  if (state_ == GripperState::kIdle) {
    target_ = width();
  } else if (state_ == GripperState::kGrasping) {
    grasp_.opens = grasp_.low > width();
    target_ = grasp_.opens ? parameters_.max_width : 0.0;
  }
  ramp_.start(width(), target_, speed_);
  standstill_.restart();
  for (FingerForce& finger : fingers_) {
    finger.restart();
  }
}

void GripperUnit::idle(GripperOutcome outcome) noexcept {
  tickets_.close(outcome);
  next_.kind = Command::Kind::kNone;
  state_ = GripperState::kIdle;
  drive(0.0, 0.0);
}

// --- one tick ------------------------------------------------------------------------------------

void GripperUnit::observe(const HandMeasurement& measurement) noexcept {
  if (isFinite(measurement)) {
    measured_ = measurement;
  }
}

std::array<double, 2> GripperUnit::step(const HandMeasurement& measurement,
                                        double period) noexcept {
  if (!isFinite(measurement) || !isNotNegative(period)) {
    return {};
  }
  measured_ = measurement;
  since_ += period;
  if (next_.kind != Command::Kind::kNone && since_ >= parameters_.latency.start) {
    execute(next_);
  }
  if (!begun_) {
    begin();
  }
  if (state_ == GripperState::kMoving) {
    advanceMove(resting(period));
  } else if (state_ == GripperState::kGrasping) {
    advanceGrasp(resting(period), period);
  }
  const std::array<double, 2> force = pressing_ ? press() : follow(period);
  warm(force, period);
  return force;
}

void GripperUnit::warm(const std::array<double, 2>& force, double period) noexcept {
  const double load =
      std::min((std::abs(force[0]) + std::abs(force[1])) / parameters_.max_force, 1.0);
  const double end = parameters_.room_temperature + parameters_.temperature_rise * load * load;
  temperature_ = end + (temperature_ - end) * std::exp(-period / parameters_.temperature_time);
}

bool GripperUnit::resting(double period) noexcept {
  double threshold = parameters_.resting_threshold;
  if (pressing_ || ramp_.arrived()) {
    standstill_.countFromNow();
  } else {
    // A slow command must not count as standstill.
    threshold = std::min(threshold, std::max(0.25 * speed_, kMinSpeed));
  }
  // Motion of the fingers when an object is released is not yet the commanded motion.
  const bool commanded =
      pressing_ || ramp_.arrived() || std::abs(ramp_.width() - width()) > kMaxLead;
  return standstill_.update(measured_.dq[0] + measured_.dq[1], threshold, period, commanded);
}

void GripperUnit::advanceMove(bool resting) noexcept {
  const bool too_early = since_ < parameters_.latency.shortest && homing_ != Homing::kCloses;
  if (!resting || too_early) {
    return;
  }
  if (std::abs(width() - ramp_.target()) > parameters_.move_tolerance) {
    idle(GripperOutcome::kFailed);
  } else if (homing_ == Homing::kCloses) {
    drive(parameters_.max_width, parameters_.homing_speed);
    homing_ = Homing::kOpens;
  } else {
    homed_ = homed_ || homing_ == Homing::kOpens;
    tickets_.close(GripperOutcome::kSucceeded);
    state_ = GripperState::kIdle;  // the ramp keeps the desired width
  }
}

void GripperUnit::advanceGrasp(bool resting, double period) noexcept {
  if (!pressing_) {
    if (resting) {
      pressing_ = true;
      pressed_ = 0.0;
      standstill_.restart();
    }
    return;
  }
  pressed_ += period;
  if (!resting || pressed_ < kForceRise || since_ < parameters_.latency.shortest) {
    return;
  }
  if (withinGrasp()) {
    tickets_.close(GripperOutcome::kSucceeded);
    state_ = GripperState::kHolding;
  } else {
    idle(GripperOutcome::kFailed);
  }
}

std::array<double, 2> GripperUnit::follow(double period) noexcept {
  if (!begun_) {
    begin();
  }
  ramp_.step(period);
  std::array<double, 2> force;
  for (std::size_t i = 0; i < 2; i++) {
    force[i] = fingers_[i].update(0.5 * ramp_.width() - measured_.q[i],
                                  0.5 * ramp_.velocity() - measured_.dq[i], period);
  }
  return force;
}

// The fingers center on each other while they press, like the mechanics of the real hand.
std::array<double, 2> GripperUnit::press() const noexcept {
  const double rise = std::min(pressed_ / kForceRise, 1.0);
  std::array<double, 2> force;
  for (std::size_t i = 0; i < 2; i++) {
    force[i] = rise * (grasp_.opens ? grasp_.force : -grasp_.force) -
               grasp_.damping * measured_.dq[i] +
               fingers_[i].gains().p * (measured_.q[1 - i] - measured_.q[i]);
  }
  return force;
}

}  // namespace franka_sim
