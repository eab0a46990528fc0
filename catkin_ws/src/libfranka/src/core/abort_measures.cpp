// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "abort_measures.h"

#include <franka_core/motion_steps.h>
#include <franka_core/tick.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace franka_core {

namespace {

using Twist = Eigen::Map<const Eigen::Matrix<double, 6, 1>>;

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

/// The step of the joints that either joint generator's command makes; empty if none runs.
std::optional<JointSample> jointStep(const Step& step) {
  const JointSample last{step.before.q_d, step.before.dq_d, step.before.ddq_d, {}};
  if (isUsed(step.command.q_c)) {
    return stepToPositions(last, step.command.q_c);
  }
  if (isUsed(step.command.dq_c)) {
    return stepByVelocities(last, step.command.dq_c);
  }
  return std::nullopt;
}

/// The step of the end effector that either Cartesian generator's command makes; empty if none
/// runs.
std::optional<CartesianSample> cartesianStep(const Step& step) {
  CartesianSample last;
  last.pose = step.before.O_T_EE_c;
  last.twist = step.before.O_dP_EE_c;
  last.acceleration = step.before.O_ddP_EE_c;
  if (isUsed(step.command.O_T_EE_c)) {
    return stepToPose(last, step.command.O_T_EE_c, 0.0);
  }
  if (isUsed(step.command.O_dP_EE_c)) {
    return stepByTwist(last, step.command.O_dP_EE_c, 0.0);
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

struct TimedSample {
  JointSample joints;
  std::uint64_t time;  // [ms]
};

/// The desired joints of the motion and of the step that would have followed. The last state is not
/// included: the robot already brakes in it.
std::vector<TimedSample> solvedSamples(const std::vector<AbortRecord>& log) {
  std::vector<TimedSample> samples;
  for (std::size_t k = 0; k + 1 < log.size(); k++) {
    const RobotState& state = log[k].state;
    JointSample joints{state.q_d, state.dq_d, state.ddq_d, {}};
    if (k > 0 && state.message_id > log[k - 1].state.message_id) {
      const RobotState& before = log[k - 1].state;
      const double period = kTick * static_cast<double>(state.message_id - before.message_id);
      for (std::size_t i = 0; i < 7; i++) {
        joints.dddq[i] = (state.ddq_d[i] - before.ddq_d[i]) / period;
      }
    }
    samples.push_back({joints, state.message_id});
  }
  if (!samples.empty()) {
    TimedSample next = samples.back();
    next.time++;
    for (std::size_t i = 0; i < 7; i++) {
      next.joints.ddq[i] += next.joints.dddq[i] * kTick;
      next.joints.dq[i] += next.joints.ddq[i] * kTick;
      next.joints.q[i] += next.joints.dq[i] * kTick;
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

double AbortMeasures::jointLimit(int order, std::size_t joint, double q, double value) const {
  const double velocity =
      value >= 0.0 ? limits_.highestVelocity(joint, q) : -limits_.lowestVelocity(joint, q);
  return pick(order, velocity, limits_.arm.ddq[joint], limits_.arm.dddq[joint]);
}

std::optional<Excess> AbortMeasures::commandedJoints(int order) const {
  return worstStep(log_, [&](const Step& step, const auto& found) {
    const std::optional<JointSample> joints = jointStep(step);
    for (std::size_t i = 0; joints && i < 7; i++) {
      const double value = pick(order, joints->dq, joints->ddq, joints->dddq)[i];
      found({jointName(i), "rad", value, jointLimit(order, i, step.before.q_d[i], value)});
    }
  });
}

std::optional<Excess> AbortMeasures::commandedTwist(int order) const {
  return worstStep(log_, [&](const Step& step, const auto& found) {
    const std::optional<CartesianSample> sample = cartesianStep(step);
    if (!sample) {
      return;
    }
    const Twist value(pick(order, sample->twist, sample->acceleration, sample->jerk).data());
    found(
        {"the translation", "m", value.head<3>().norm(), boundOf(order, limits_.arm.translation)});
    found({"the rotation", "rad", value.tail<3>().norm(), boundOf(order, limits_.arm.rotation)});
  });
}

std::optional<Excess> AbortMeasures::commandedElbow(int& order) const {
  std::optional<Excess> excess;
  for (order = 1; order <= 3; order++) {
    excess = worstStep(log_, [&](const Step& step, const auto& found) {
      if (!step.command.valid_elbow) {
        return;
      }
      const RobotState& before = step.before;
      const ElbowSample elbow = stepToElbow(
          {before.elbow_c[0], before.delbow_c[0], before.ddelbow_c[0]}, step.command.elbow_c[0]);
      found({"the elbow (joint 3)", "rad", pick(order, elbow.dq3, elbow.ddq3, elbow.dddq3),
             boundOf(order, limits_.elbow())});
    });
    if (!excess || excess->ratio() > 1.0) {
      return excess;
    }
  }
  order = 3;
  return excess;
}

std::optional<Excess> AbortMeasures::commandedTorques() const {
  return worstStep(log_, [&](const Step& step, const auto& found) {
    for (std::size_t i = 0; i < 7; i++) {
      const double rate = (step.command.tau_J_d[i] - step.before.tau_J_d[i]) / kTick;
      found({jointName(i), "Nm", rate, limits_.arm.dtau[i]});
    }
  });
}

std::optional<Excess> AbortMeasures::solvedJoints(int order) const {
  std::optional<Excess> worst;
  for (const auto& [joints, time] : solvedSamples(log_)) {
    for (std::size_t i = 0; i < 7; i++) {
      const double value = pick(order, joints.dq, joints.ddq, joints.dddq)[i];
      keepWorse(worst, {jointName(i), "rad", value, jointLimit(order, i, joints.q[i], value)}, time,
                log_);
    }
  }
  return worst && worst->value != 0.0 ? worst : std::nullopt;
}

std::optional<std::array<double, 7>> AbortMeasures::solvedPositions() const {
  const std::vector<TimedSample> samples = solvedSamples(log_);
  return samples.empty() ? std::nullopt : std::make_optional(samples.back().joints.q);
}

std::optional<Excess> AbortMeasures::measuredJoints() const {
  std::optional<Excess> worst;
  for (const AbortRecord& record : log_) {
    for (std::size_t i = 0; i < 7; i++) {
      keepWorse(worst, {jointName(i), "rad", record.state.dq[i], limits_.arm.dq[i]},
                record.state.message_id, log_);
    }
  }
  return worst;
}

}  // namespace franka_core
