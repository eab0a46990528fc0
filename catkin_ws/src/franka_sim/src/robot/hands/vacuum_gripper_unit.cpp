// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/robot/hands/vacuum_gripper_unit.h>

#include <cmath>

#include "robot/hands/parameter_check.h"

namespace franka_sim {

namespace {

constexpr double kMillisecond = 1e-3;  // [s]

const VacuumGripperParameters& checked(const VacuumGripperParameters& p) {
  const auto require = [](bool condition, const char* name, const char* must) {
    requireOf("vacuum gripper", condition, name, must);
  };
  const auto require_positive = [&](double value, const char* name) {
    require(std::isfinite(value) && value > 0.0, name, "a positive number");
  };
  require_positive(p.sealed_vacuum, "sealed_vacuum");
  require_positive(p.pump_time, "pump_time");
  require_positive(p.leak_time, "leak_time");
  require_positive(p.blow_time, "blow_time");
  require_positive(p.detached_vacuum, "detached_vacuum");
  require(p.open_vacuum >= 0.0 && p.open_vacuum < p.part_vacuum, "open_vacuum",
          "from 0 to below part_vacuum");
  require(p.part_vacuum < p.sealed_vacuum, "part_vacuum", "below sealed_vacuum");
  require(std::isfinite(p.hysteresis) && p.hysteresis >= 0.0, "hysteresis",
          "a number that is not negative");
  require(p.idle_power >= 0.0 && p.idle_power <= 100.0, "idle_power", "from 0 to 100 percent");
  return p;
}

}  // namespace

VacuumGripperUnit::VacuumGripperUnit(const VacuumGripperParameters& parameters)
    : parameters_(checked(parameters)) {}

VacuumGripperUnit::Ticket VacuumGripperUnit::vacuum(double vacuum, std::int64_t timeout) noexcept {
  if (!(vacuum > 0.0) || vacuum > parameters_.sealed_vacuum || timeout < 0 ||
      health_ == PumpHealth::kRed) {
    return 0;
  }
  const Ticket ticket = tickets_.open();
  set_point_ = vacuum;
  begin(State::kPumping, timeout);
  return ticket;
}

VacuumGripperUnit::Ticket VacuumGripperUnit::dropOff(std::int64_t timeout) noexcept {
  if (timeout < 0) {
    return 0;
  }
  const Ticket ticket = tickets_.open();
  begin(State::kBlowing, timeout);
  return ticket;
}

VacuumGripperUnit::Ticket VacuumGripperUnit::stop() noexcept {
  const Ticket ticket = tickets_.open();
  end(State::kOff, GripperOutcome::kSucceeded);
  return ticket;
}

void VacuumGripperUnit::restart() noexcept {
  end(State::kOff, GripperOutcome::kInterrupted);
  level_ = 0.0;
  detached_ = false;
}

void VacuumGripperUnit::setHealth(PumpHealth health) noexcept {
  health_ = health;
  if (health == PumpHealth::kRed && (state_ == State::kPumping || state_ == State::kHolding)) {
    end(State::kOff, GripperOutcome::kFailed);
  }
}

void VacuumGripperUnit::begin(State state, std::int64_t timeout) noexcept {
  state_ = state;
  detached_ = false;
  elapsed_ = 0.0;
  timeout_ = static_cast<double>(timeout) * kMillisecond;
}

void VacuumGripperUnit::end(State state, GripperOutcome outcome) noexcept {
  tickets_.close(outcome);
  state_ = state;
}

void VacuumGripperUnit::step(double period) noexcept {
  flow(period);
  if (state_ != State::kPumping && state_ != State::kBlowing) {
    return;
  }
  elapsed_ += period;
  const bool blowing = state_ == State::kBlowing;
  if (blowing ? level_ <= parameters_.detached_vacuum : level_ >= set_point_) {
    detached_ = blowing;
    end(blowing ? State::kOff : State::kHolding, GripperOutcome::kSucceeded);
  } else if (elapsed_ >= timeout_ - 0.5 * period) {
    end(State::kOff, GripperOutcome::kFailed);
  }
}

void VacuumGripperUnit::flow(double period) noexcept {
  const VacuumGripperParameters& p = parameters_;
  if (state_ == State::kBlowing) {
    approach(0.0, p.blow_time, period);
  } else if (state_ == State::kOff) {
    approach(0.0, part_ ? p.leak_time : p.blow_time, period);
  } else if (!part_) {
    // Air enters through an open cup faster than the pump works.
    approach(p.open_vacuum, level_ > p.open_vacuum ? p.blow_time : p.pump_time, period);
  } else if (state_ == State::kPumping || level_ < set_point_) {
    approach(p.sealed_vacuum, p.pump_time, period);
  }
}

void VacuumGripperUnit::approach(double level, double time, double period) noexcept {
  level_ = level + (level_ - level) * std::exp(-period / time);
}

double VacuumGripperUnit::power() const noexcept {
  if (state_ == State::kPumping || (state_ == State::kHolding && level_ < set_point_)) {
    return 100.0;
  }
  return state_ == State::kHolding ? parameters_.idle_power : 0.0;
}

bool VacuumGripperUnit::inControlRange() const noexcept {
  return state_ == State::kHolding && level_ >= set_point_ - parameters_.hysteresis;
}

}  // namespace franka_sim
