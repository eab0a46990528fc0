// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "abort_measures.h"

#include <franka_core/limits.h>
#include <franka_core/rotations.h>
#include <franka_core/tick.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace franka_core {

namespace {

using Matrix4 = Eigen::Map<const Eigen::Matrix4d>;
using Twist = Eigen::Matrix<double, 6, 1>;
using Joints = std::array<double, 7>;

/// Two successive records: the command answers the first one's state.
struct Step {
  const RobotState& before;
  const RobotCommand& command;
};

/// @param time of the excess [ms]
void keepWorse(std::optional<Excess>& worst, Excess excess, std::uint64_t time,
               const std::vector<AbortRecord>& log) {
  if (!worst || excess.ratio() > worst->ratio()) {
    const std::uint64_t end = log.back().state.message_id;
    excess.age = end - std::min(end, time);
    worst = std::move(excess);
  }
}

/// The largest excess that `measure(step, found)` reports over all steps of the log.
template <typename Measure>
std::optional<Excess> worstStep(const std::vector<AbortRecord>& log, Measure measure) {
  std::optional<Excess> worst;
  for (std::size_t i = 1; i < log.size(); i++) {
    const RobotState& before = log[i - 1].state;
    measure(Step{before, log[i].command},
            [&](Excess excess) { keepWorse(worst, std::move(excess), before.message_id, log); });
  }
  return worst;
}

/// Commanded joint velocity of either joint generator; empty if none runs.
std::optional<Joints> velocityOf(const Step& step) {
  if (isUsed(step.command.q_c)) {
    Joints dq{};
    for (std::size_t i = 0; i < 7; i++) {
      dq[i] = (step.command.q_c[i] - step.before.q_d[i]) / kTick;
    }
    return dq;
  }
  if (isUsed(step.command.dq_c)) {
    return step.command.dq_c;
  }
  return std::nullopt;
}

/// Commanded twist [m/s, rad/s] of either Cartesian generator; empty if none runs.
std::optional<Twist> twistOf(const Step& step) {
  if (isUsed(step.command.O_T_EE_c)) {
    return twistBetween(Matrix4(step.before.O_T_EE_c.data()), Matrix4(step.command.O_T_EE_c.data()),
                        kTick);
  }
  if (isUsed(step.command.O_dP_EE_c)) {
    return Eigen::Map<const Twist>(step.command.O_dP_EE_c.data());
  }
  return std::nullopt;
}

template <typename Value>
const Value& pick(int order, const Value& velocity, const Value& acceleration, const Value& jerk) {
  return order == 1 ? velocity : (order == 2 ? acceleration : jerk);
}

double boundOf(int order, const DerivativeLimits& limits) {
  return pick(order, limits.velocity, limits.acceleration, limits.jerk);
}

/// Joints at one moment, with their derivatives.
struct JointSample {
  Joints q, dq, ddq, dddq;
  std::uint64_t time;
};

/// The desired joints of the motion and of the step that would have followed. The last state is not
/// included: the robot already brakes in it.
std::vector<JointSample> solvedSamples(const std::vector<AbortRecord>& log) {
  std::vector<JointSample> samples;
  for (std::size_t k = 0; k + 1 < log.size(); k++) {
    const RobotState& state = log[k].state;
    JointSample sample{state.q_d, state.dq_d, state.ddq_d, {}, state.message_id};
    if (k > 0 && state.message_id > log[k - 1].state.message_id) {
      const RobotState& before = log[k - 1].state;
      const double period = kTick * static_cast<double>(state.message_id - before.message_id);
      for (std::size_t i = 0; i < 7; i++) {
        sample.dddq[i] = (state.ddq_d[i] - before.ddq_d[i]) / period;
      }
    }
    samples.push_back(sample);
  }
  if (!samples.empty()) {
    JointSample next = samples.back();
    next.time++;
    for (std::size_t i = 0; i < 7; i++) {
      next.ddq[i] += next.dddq[i] * kTick;
      next.dq[i] += next.ddq[i] * kTick;
      next.q[i] += next.dq[i] * kTick;
    }
    samples.push_back(next);
  }
  return samples;
}

}  // namespace

double Excess::ratio() const {
  if (limit > 0.0) {
    return std::abs(value) / limit;
  }
  // At the end of its range an FR3's joint may not move further at all.
  return value != 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

std::string jointName(std::size_t i) { return "joint " + std::to_string(i + 1); }

AbortMeasures::AbortMeasures(const std::vector<AbortRecord>& log, unsigned version)
    : log_(log), version_(version) {}

double AbortMeasures::velocityLimit(std::size_t joint, double q, double direction) const {
  if (version_ <= 5) {
    return limitsOfProtocol(version_).dq[joint];
  }
  const PositionVelocityLimits& limits =
      version_ >= 10 ? kFr3PositionVelocityLimitsFrom59 : kFr3PositionVelocityLimits;
  return direction >= 0.0 ? upperVelocityLimit(limits, joint, q)
                          : -lowerVelocityLimit(limits, joint, q);
}

std::optional<Excess> AbortMeasures::commandedJoints(int order) const {
  const ArmLimits& limits = limitsOfProtocol(version_);
  return worstStep(log_, [&](const Step& step, const auto& found) {
    const auto dq = velocityOf(step);
    for (std::size_t i = 0; dq && i < 7; i++) {
      const double ddq = ((*dq)[i] - step.before.dq_d[i]) / kTick;
      const double dddq = (ddq - step.before.ddq_d[i]) / kTick;
      const double value = pick(order, (*dq)[i], ddq, dddq);
      const double dq_max = velocityLimit(i, step.before.q_d[i], value);
      found({jointName(i), "rad", value, pick(order, dq_max, limits.ddq[i], limits.dddq[i])});
    }
  });
}

std::optional<Excess> AbortMeasures::commandedTwist(int order) const {
  const ArmLimits& limits = limitsOfProtocol(version_);
  return worstStep(log_, [&](const Step& step, const auto& found) {
    const auto twist = twistOf(step);
    if (!twist) {
      return;
    }
    const Twist acceleration =
        (*twist - Eigen::Map<const Twist>(step.before.O_dP_EE_c.data())) / kTick;
    const Twist jerk =
        (acceleration - Eigen::Map<const Twist>(step.before.O_ddP_EE_c.data())) / kTick;
    const Twist& value = pick(order, *twist, acceleration, jerk);
    found({"the translation", "m", value.head<3>().norm(), boundOf(order, limits.translation)});
    found({"the rotation", "rad", value.tail<3>().norm(), boundOf(order, limits.rotation)});
  });
}

std::optional<Excess> AbortMeasures::commandedElbow(int& order) const {
  const ArmLimits& limits = limitsOfProtocol(version_);
  DerivativeLimits bounds = limits.elbow;
  bounds.velocity = std::max(bounds.velocity, limits.documented_elbow_velocity);
  std::optional<Excess> excess;
  for (order = 1; order <= 3; order++) {
    excess = worstStep(log_, [&](const Step& step, const auto& found) {
      if (!step.command.valid_elbow) {
        return;
      }
      const double velocity = (step.command.elbow_c[0] - step.before.elbow_c[0]) / kTick;
      const double acceleration = (velocity - step.before.delbow_c[0]) / kTick;
      const double jerk = (acceleration - step.before.ddelbow_c[0]) / kTick;
      found({"the elbow (joint 3)", "rad", pick(order, velocity, acceleration, jerk),
             boundOf(order, bounds)});
    });
    if (!excess || excess->ratio() > 1.0) {
      return excess;
    }
  }
  order = 3;
  return excess;
}

std::optional<Excess> AbortMeasures::commandedTorques() const {
  const ArmLimits& limits = limitsOfProtocol(version_);
  return worstStep(log_, [&](const Step& step, const auto& found) {
    for (std::size_t i = 0; i < 7; i++) {
      const double rate = (step.command.tau_J_d[i] - step.before.tau_J_d[i]) / kTick;
      found({jointName(i), "Nm", rate, limits.dtau[i]});
    }
  });
}

std::optional<Excess> AbortMeasures::solvedJoints(int order) const {
  const ArmLimits& limits = limitsOfProtocol(version_);
  std::optional<Excess> worst;
  for (const JointSample& sample : solvedSamples(log_)) {
    for (std::size_t i = 0; i < 7; i++) {
      const double value = pick(order, sample.dq[i], sample.ddq[i], sample.dddq[i]);
      const double dq_max = velocityLimit(i, sample.q[i], value);
      keepWorse(worst,
                {jointName(i), "rad", value, pick(order, dq_max, limits.ddq[i], limits.dddq[i])},
                sample.time, log_);
    }
  }
  return worst && worst->value != 0.0 ? worst : std::nullopt;
}

std::optional<std::array<double, 7>> AbortMeasures::solvedPositions() const {
  const std::vector<JointSample> samples = solvedSamples(log_);
  return samples.empty() ? std::nullopt : std::make_optional(samples.back().q);
}

std::optional<Excess> AbortMeasures::measuredJoints() const {
  const ArmLimits& limits = limitsOfProtocol(version_);
  std::optional<Excess> worst;
  for (const AbortRecord& record : log_) {
    for (std::size_t i = 0; i < 7; i++) {
      keepWorse(worst, {jointName(i), "rad", record.state.dq[i], limits.dq[i]},
                record.state.message_id, log_);
    }
  }
  return worst;
}

}  // namespace franka_core
