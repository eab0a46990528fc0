// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/abort_diagnosis.h>
#include <franka_core/error_names.h>
#include <franka_core/limits.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <optional>

namespace franka_core {

namespace {

constexpr double kTick = 1e-3;  // [s]

using Matrix4 = Eigen::Map<const Eigen::Matrix4d>;
using Twist = Eigen::Matrix<double, 6, 1>;

/// A value that was commanded or measured, and what is allowed.
struct Excess {
  std::string what;  ///< "joint 3", "the translation"
  double value{0.0};
  double limit{0.0};
  std::uint64_t time{0};  ///< [ms]

  double ratio() const { return limit > 0.0 ? std::abs(value) / limit : 0.0; }
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

std::string jointName(std::size_t i) { return "joint " + std::to_string(i + 1); }

/// Two successive records: the command answered the first one's state.
struct Step {
  const RobotState& before;
  const RobotCommand& command;
  std::uint64_t time;
};

/// The excess that is farthest beyond its limit, over the steps of the log.
using Measure = std::function<void(const Step&, std::vector<Excess>&)>;

std::optional<Excess> worst(const std::vector<AbortRecord>& log, const Measure& measure) {
  std::optional<Excess> found;
  std::vector<Excess> all;
  for (std::size_t i = 1; i < log.size(); i++) {
    all.clear();
    measure({log[i - 1].state, log[i].command, log[i - 1].state.message_id}, all);
    for (Excess& excess : all) {
      excess.time = log[i - 1].state.message_id;
      if (!found || excess.ratio() > found->ratio()) {
        found = excess;
      }
    }
  }
  return found;
}

bool isUsed(const double* values, std::size_t size) {
  return std::any_of(values, values + size, [](double value) { return value != 0.0; });
}

/// Commanded joint velocity, whichever joint generator runs; nothing if none does.
std::optional<std::array<double, 7>> commandedVelocity(const Step& step) {
  if (isUsed(step.command.q_c.data(), 7)) {
    std::array<double, 7> dq{};
    for (std::size_t i = 0; i < 7; i++) {
      dq[i] = (step.command.q_c[i] - step.before.q_d[i]) / kTick;
    }
    return dq;
  }
  if (isUsed(step.command.dq_c.data(), 7)) {
    return step.command.dq_c;
  }
  return std::nullopt;
}

/// Commanded twist [m/s, rad/s], whichever Cartesian generator runs; nothing if none does.
std::optional<Twist> commandedTwist(const Step& step) {
  if (isUsed(step.command.O_T_EE_c.data(), 16)) {
    const Matrix4 to(step.command.O_T_EE_c.data());
    const Matrix4 from(step.before.O_T_EE_c.data());
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(to.topLeftCorner<3, 3>() * from.topLeftCorner<3, 3>().transpose()));
    Twist twist;
    twist << (to.topRightCorner<3, 1>() - from.topRightCorner<3, 1>()) / kTick,
        turn.axis() * turn.angle() / kTick;
    return twist;
  }
  if (isUsed(step.command.O_dP_EE_c.data(), 6)) {
    return Eigen::Map<const Twist>(step.command.O_dP_EE_c.data());
  }
  return std::nullopt;
}

class Diagnosis {
 public:
  Diagnosis(const std::vector<AbortRecord>& log, unsigned version)
      : log_(log), version_(version), limits_(limitsOfProtocol(version)) {}

  std::string sentence(std::size_t flag) const {
    return std::string(kErrorNames[flag]) + ": " + explain(flag);
  }

 private:
  std::string explain(std::size_t flag) const;

  static std::string compare(const std::optional<Excess>& excess, const char* quantity,
                             const char* unit) {
    if (!excess) {
      return std::string("the log shows no commands from which the ") + quantity +
             " could be computed.";
    }
    return excess->what + " was commanded " + quantity + " of " + number(excess->value) + " " +
           unit + ", and " + number(excess->limit) + " are allowed (at " +
           std::to_string(excess->time) + " ms).";
  }

  std::optional<Excess> jointDerivative(int order) const;
  std::optional<Excess> twistDerivative(int order) const;
  std::optional<Excess> torqueRate() const;
  std::optional<Excess> measuredVelocity() const;
  std::string outside(const char* verb, bool commanded) const;
  std::string collision() const;
  std::string deviation() const;
  std::string lostPackets() const;
  std::string startPose(bool joints) const;
  std::string sensorTorque() const;
  double velocityLimit(std::size_t joint, double q, double direction) const;

  const std::vector<AbortRecord>& log_;
  unsigned version_;
  const ArmLimits& limits_;
};

double Diagnosis::velocityLimit(std::size_t joint, double q, double direction) const {
  if (version_ <= 5) {
    return limits_.dq[joint];
  }
  const PositionVelocityLimits& limits =
      version_ >= 10 ? kFr3PositionVelocityLimitsFrom59 : kFr3PositionVelocityLimits;
  return direction >= 0.0 ? upperVelocityLimit(limits, joint, q)
                          : -lowerVelocityLimit(limits, joint, q);
}

std::optional<Excess> Diagnosis::jointDerivative(int order) const {
  return worst(log_, [&](const Step& step, std::vector<Excess>& found) {
    const auto dq = commandedVelocity(step);
    for (std::size_t i = 0; dq && i < 7; i++) {
      const double ddq = ((*dq)[i] - step.before.dq_d[i]) / kTick;
      const double dddq = (ddq - step.before.ddq_d[i]) / kTick;
      const double value = order == 1 ? (*dq)[i] : (order == 2 ? ddq : dddq);
      const double limit = order == 1 ? velocityLimit(i, step.before.q_d[i], value)
                                      : (order == 2 ? limits_.ddq[i] : limits_.dddq[i]);
      found.push_back({jointName(i), value, limit, 0});
    }
  });
}

std::optional<Excess> Diagnosis::twistDerivative(int order) const {
  const auto pick = [order](const DerivativeLimits& limits) {
    return order == 1 ? limits.velocity : (order == 2 ? limits.acceleration : limits.jerk);
  };
  return worst(log_, [&](const Step& step, std::vector<Excess>& found) {
    const auto twist = commandedTwist(step);
    if (!twist) {
      return;
    }
    const Twist acceleration =
        (*twist - Eigen::Map<const Twist>(step.before.O_dP_EE_c.data())) / kTick;
    const Twist jerk =
        (acceleration - Eigen::Map<const Twist>(step.before.O_ddP_EE_c.data())) / kTick;
    const Twist& value = order == 1 ? *twist : (order == 2 ? acceleration : jerk);
    found.push_back({"the translation", value.head<3>().norm(), pick(limits_.translation), 0});
    found.push_back({"the rotation", value.tail<3>().norm(), pick(limits_.rotation), 0});
  });
}

std::optional<Excess> Diagnosis::torqueRate() const {
  return worst(log_, [&](const Step& step, std::vector<Excess>& found) {
    for (std::size_t i = 0; i < 7; i++) {
      const double rate = (step.command.tau_J_d[i] - step.before.tau_J_d[i]) / kTick;
      found.push_back({jointName(i), rate, limits_.dtau[i], 0});
    }
  });
}

std::optional<Excess> Diagnosis::measuredVelocity() const {
  return worst(log_, [&](const Step& step, std::vector<Excess>& found) {
    for (std::size_t i = 0; i < 7; i++) {
      found.push_back({jointName(i), step.before.dq[i], limits_.dq[i], 0});
    }
  });
}

std::string Diagnosis::outside(const char* verb, bool commanded) const {
  std::string text;
  double farthest = -1e9;
  const auto look = [&](const std::array<double, 7>& q) {
    for (std::size_t i = 0; i < 7; i++) {
      const double beyond = std::max(limits_.q_min[i] - q[i], q[i] - limits_.q_max[i]);
      if (beyond > farthest) {
        farthest = beyond;
        text = jointName(i) + " " + verb + " " + number(q[i]) + " rad, and its range is " +
               number(limits_.q_min[i]) + " to " + number(limits_.q_max[i]) + " rad.";
      }
    }
  };
  for (const AbortRecord& record : log_) {
    if (!commanded) {
      look(record.state.q);
    } else if (isUsed(record.command.q_c.data(), 7)) {
      look(record.command.q_c);
    } else {
      look(record.state.q_d);
    }
  }
  return text;
}

std::string Diagnosis::collision() const {
  static const char* const kAxes[] = {"x", "y", "z", "roll", "pitch", "yaw"};
  const RobotState& state = log_.back().state;
  std::string text;
  for (std::size_t i = 0; i < 7; i++) {
    if (state.joint_collision[i] != 0.0) {
      text += (text.empty() ? "" : ", ") + jointName(i) + " (external torque " +
              number(state.tau_ext_hat_filtered[i]) + " Nm)";
    }
  }
  for (std::size_t i = 0; i < 6; i++) {
    if (state.cartesian_collision[i] != 0.0) {
      text += (text.empty() ? "" : ", ") + std::string(kAxes[i]) + " (external " +
              (i < 3 ? "force " : "torque ") + number(state.O_F_ext_hat_K[i]) +
              (i < 3 ? " N)" : " Nm)");
    }
  }
  return text.empty() ? "the log does not show where. Check the configured load (setLoad) and the "
                        "thresholds (setCollisionBehavior)."
                      : "a collision was felt at " + text +
                            ". If nothing was touched, check the configured load (setLoad) and the "
                            "thresholds "
                            "(setCollisionBehavior).";
}

std::string Diagnosis::deviation() const {
  const RobotState& state = log_.back().state;
  const Matrix4 is(state.O_T_EE.data());
  const Matrix4 wanted(state.O_T_EE_d.data());
  const double distance = (is.topRightCorner<3, 1>() - wanted.topRightCorner<3, 1>()).norm();
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(is.topLeftCorner<3, 3>() * wanted.topLeftCorner<3, 3>().transpose()));
  return "the end effector was " + number(1e3 * distance) + " mm and " +
         number(turn.angle() * 57.29577951308232) + " degrees away from its desired pose.";
}

std::string Diagnosis::lostPackets() const {
  const std::uint64_t lost = statesLost(log_);
  const double rate =
      log_.size() >= 2 ? log_[log_.size() - 2].state.control_command_success_rate : 0.0;
  return "20 commands in a row came too late or not at all; " + std::to_string(lost) +
         " states were lost before the last one, and " + number(100.0 * rate) +
         " % of the commands before had arrived. Check the real-time priority of this program, the "
         "time its callback takes, and the network (no switch, no wireless link, CPU frequency "
         "scaling off).";
}

std::string Diagnosis::startPose(bool joints) const {
  for (std::size_t i = 1; i < log_.size(); i++) {
    const RobotState& before = log_[i - 1].state;
    const RobotCommand& command = log_[i].command;
    if (joints && isUsed(command.q_c.data(), 7)) {
      std::size_t farthest = 0;
      for (std::size_t j = 1; j < 7; j++) {
        if (std::abs(command.q_c[j] - before.q_d[j]) >
            std::abs(command.q_c[farthest] - before.q_d[farthest])) {
          farthest = j;
        }
      }
      return "the first command put " + jointName(farthest) + " at " +
             number(command.q_c[farthest]) + " rad while q_d was " + number(before.q_d[farthest]) +
             " rad. Begin at q_d.";
    }
    if (!joints && isUsed(command.O_T_EE_c.data(), 16)) {
      const double distance = (Matrix4(command.O_T_EE_c.data()).topRightCorner<3, 1>() -
                               Matrix4(before.O_T_EE_c.data()).topRightCorner<3, 1>())
                                  .norm();
      return "the first commanded pose was " + number(1e3 * distance) +
             " mm away from O_T_EE_c. Begin at O_T_EE_c.";
    }
  }
  return "the log does not hold the first command. Begin at q_d or O_T_EE_c.";
}

std::string Diagnosis::sensorTorque() const {
  const RobotState& state = log_.back().state;
  std::size_t largest = 0;
  for (std::size_t i = 1; i < 7; i++) {
    if (std::abs(state.tau_J[i]) / limits_.tau[i] >
        std::abs(state.tau_J[largest]) / limits_.tau[largest]) {
      largest = i;
    }
  }
  return jointName(largest) + " measured " + number(state.tau_J[largest]) + " Nm, and " +
         number(limits_.tau[largest]) + " Nm is its rated torque.";
}

/// The numbers of the flags: index order of fci.md 4.1.
std::string Diagnosis::explain(std::size_t flag) const {
  switch (flag) {
    case 0:
      return outside("stood at", false);
    case 3: {
      const auto excess = measuredVelocity();
      return excess ? excess->what + " moved at " + number(excess->value) + " rad/s, and " +
                          number(excess->limit) + " are allowed."
                    : "the log is too short to say which joint.";
    }
    case 6:
    case 7:
      return collision();
    case 8:
    case 9:
      return deviation();
    case 11:
      return startPose(true);
    case 12:
    case 27:
      return outside("was to go to", true);
    case 13:
    case 28:
      return compare(jointDerivative(1), "a velocity", "rad/s");
    case 14:
    case 29:
      return compare(jointDerivative(2), "an acceleration", "rad/s^2");
    case 15:
    case 30:
      return compare(jointDerivative(3), "a jerk", "rad/s^3");
    case 16:
      return startPose(false);
    case 18:
      return compare(twistDerivative(1), "a velocity", "m/s or rad/s");
    case 19:
      return compare(twistDerivative(2), "an acceleration", "m/s^2 or rad/s^2");
    case 20:
      return compare(twistDerivative(3), "a jerk", "m/s^3 or rad/s^3");
    case 25:
      return lostPackets();
    case 31:
      return "a commanded pose was no homogeneous transformation: its rotation must be "
             "orthonormal, "
             "its last row 0 0 0 1, and it must be column-major.";
    case 32:
      return compare(torqueRate(), "a change of torque", "Nm/s");
    case 34:
      return sensorTorque();
    default:
      return "see the robot's manual; the log holds no quantity that shows it.";
  }
}

}  // namespace

std::uint64_t statesLost(const std::vector<AbortRecord>& log) noexcept {
  if (log.size() < 2) {
    return 0;
  }
  const std::uint64_t last = log.back().state.message_id;
  const std::uint64_t before = log[log.size() - 2].state.message_id;
  return last > before ? last - before - 1 : 0;
}

std::vector<std::string> diagnoseAbort(const std::vector<AbortRecord>& log, unsigned version) {
  std::vector<std::string> sentences;
  if (log.empty()) {
    return sentences;
  }
  const Diagnosis diagnosis(log, version);
  for (std::size_t flag = 0; flag < kErrorCount; flag++) {
    if (log.back().state.reflex_reason[flag]) {
      sentences.push_back(diagnosis.sentence(flag));
    }
  }
  return sentences;
}

}  // namespace franka_core
