// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/abort_diagnosis.h>
#include <franka_core/limits.h>
#include <franka_core/numbers.h>
#include <franka_core/robot_error.h>
#include <franka_core/transform.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "abort_measures.h"

namespace franka_core {

namespace {

using Matrix4 = Eigen::Map<const Eigen::Matrix4d>;

std::string number(double value) { return numberText(value, 4); }

/// How many digits, four or more, show which of two numbers is larger.
int digitsToSeparate(double a, double b) {
  int digits = 4;
  while (a != b && digits < 17 && numberText(a, digits) == numberText(b, digits)) {
    digits++;
  }
  return digits;
}

/// "a velocity" and so on.
const char* derivativeName(int order) {
  return order == 1 ? "a velocity" : (order == 2 ? "an acceleration" : "a jerk");
}

/// "3 rad/s^2; the limit is 2 (3 ms before the end of the log)"
std::string againstLimit(const Excess& excess, int order) {
  const int digits = digitsToSeparate(excess.value, excess.limit);
  return numberText(excess.value, digits) + " " + excess.unit + "/s" +
         (order > 1 ? "^" + std::to_string(order) : "") + "; the limit is " +
         numberText(excess.limit, digits) + " (" + std::to_string(excess.age) +
         " ms before the end of the log)";
}

/// Distance of two poses: "3 mm and 4 degrees"
std::string distance(const std::array<double, 16>& one, const std::array<double, 16>& other) {
  const Matrix4 a(one.data()), b(other.data());
  const double way = (a.topRightCorner<3, 1>() - b.topRightCorner<3, 1>()).norm();
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(a.topLeftCorner<3, 3>() * b.topLeftCorner<3, 3>().transpose()));
  return number(1e3 * way) + " mm and " + number(turn.angle() * 57.29577951308232) + " degrees";
}

constexpr const char* kSolvedAdvice =
    " The step that the robot refused is not in the log; the ones before lead there. Move more "
    "slowly, or keep away from singular poses such as a stretched elbow.";
/// The robot ends a motion after 20 ms without a command.
constexpr double kLongAnswer = 0.02;  // [s]
constexpr const char* kNoFirstCommand = "the log does not hold the first command.";

std::string commanded(const std::optional<Excess>& excess, const char* what, int order) {
  if (!excess) {
    return std::string("the log shows no commands from which ") + what + " could be computed.";
  }
  return excess->what + " was commanded " + what + " of " + againstLimit(*excess, order) + ".";
}

std::string commanded(const std::optional<Excess>& excess, int order) {
  return commanded(excess, derivativeName(order), order);
}

/// The joint of q that is farthest beyond its range, and its position [rad].
struct Position {
  std::size_t joint{0};
  double q{0.0};
  double beyond{-1e9};
};

void keepFarther(Position& farthest, const std::array<double, 7>& q, const ArmLimits& limits) {
  for (std::size_t i = 0; i < 7; i++) {
    const double beyond = std::max(limits.q_min[i] - q[i], q[i] - limits.q_max[i]);
    if (beyond > farthest.beyond) {
      farthest = {i, q[i], beyond};
    }
  }
}

constexpr const char* kWasCommanded = "was commanded to";
constexpr const char* kWouldHaveFollowed = "would have followed the Cartesian command to";

std::string rangeOf(const Position& position, const char* verb, const ArmLimits& limits) {
  const double lowest = limits.q_min[position.joint], highest = limits.q_max[position.joint];
  const int digits =
      std::max(digitsToSeparate(position.q, lowest), digitsToSeparate(position.q, highest));
  return jointName(position.joint) + " " + verb + " " + numberText(position.q, digits) +
         " rad, and its range is " + numberText(lowest, digits) + " to " +
         numberText(highest, digits) + " rad.";
}

class Diagnosis {
 public:
  Diagnosis(const std::vector<AbortRecord>& log, unsigned version)
      : log_(log), measures_(log, version), limits_(measures_.limits().arm) {}

  std::string sentence(std::size_t flag) const {
    return std::string(kErrorNames[flag]) + ": " + explain(flag);
  }

 private:
  std::string explain(std::size_t flag) const;

  Position commandedPosition() const;
  Position solvedPosition() const;
  std::string positionViolation() const;
  std::string unreachable() const;
  std::string solved(int order) const;
  std::string measuredVelocity() const;
  std::string collision() const;
  std::string deviation() const;
  std::string lostPackets() const;
  std::string startJoints() const;
  std::string startPose() const;
  const AbortRecord* elbowCommand(bool first) const;
  std::string startElbow() const;
  std::string elbowLimit() const;
  std::string elbowSign(bool first) const;
  std::string sensorTorque() const;
  std::string invalidFrame() const;

  const std::vector<AbortRecord>& log_;
  AbortMeasures measures_;
  const ArmLimits& limits_;
};

std::string Diagnosis::solved(int order) const {
  const std::optional<Excess> excess = measures_.solvedJoints(order);
  if (!excess) {
    return "the log is too short to say which joint the Cartesian command would have moved too "
           "fast.";
  }
  return excess->what + " would have followed the Cartesian command with " + derivativeName(order) +
         " of " + againstLimit(*excess, order) + "." + kSolvedAdvice;
}

std::string Diagnosis::measuredVelocity() const {
  const std::optional<Excess> excess = measures_.measuredJoints();
  return excess->what + " moved at " + againstLimit(*excess, 1) + ".";
}

Position Diagnosis::commandedPosition() const {
  Position farthest;
  for (const AbortRecord& record : log_) {
    keepFarther(farthest, isUsed(record.command.q_c) ? record.command.q_c : record.state.q_d,
                limits_);
  }
  return farthest;
}

Position Diagnosis::solvedPosition() const {
  Position farthest;
  keepFarther(farthest, measures_.solvedPositions().value_or(log_.back().state.q_d), limits_);
  return farthest;
}

std::string Diagnosis::positionViolation() const {
  Position measured;
  for (const AbortRecord& record : log_) {
    keepFarther(measured, record.state.q, limits_);
  }
  // From system 5.7.2 on this flag also reports commanded positions.
  const bool cartesian = std::any_of(log_.begin(), log_.end(), [](const AbortRecord& record) {
    return isUsed(record.command.O_T_EE_c) || isUsed(record.command.O_dP_EE_c);
  });
  const Position commanded_position = cartesian ? solvedPosition() : commandedPosition();
  if (measured.beyond <= 0.0 && commanded_position.beyond > 0.0) {
    return rangeOf(commanded_position, cartesian ? kWouldHaveFollowed : kWasCommanded, limits_);
  }
  if (measured.beyond <= 0.0 && !cartesian) {
    const std::string text = unreachable();
    if (!text.empty()) {
      return text;
    }
  }
  return rangeOf(measured, "stood at", limits_);
}

/// For targets of the asynchronous generator (protocol 10) that no allowed velocity reaches.
std::string Diagnosis::unreachable() const {
  for (auto record = log_.rbegin(); record != log_.rend(); ++record) {
    const std::array<double, 7>& q_c = record->command.q_c;
    for (std::size_t i = 0; isUsed(q_c) && i < 7; i++) {
      const JointRange reach = measures_.limits().reach(i);
      if (q_c[i] < reach.lowest || q_c[i] > reach.highest) {
        return jointName(i) + " " + kWasCommanded + " " + number(q_c[i]) +
               " rad, and its velocity limit, which shrinks towards the ends of its range, is 0 "
               "outside of " +
               number(reach.lowest) + " to " + number(reach.highest) + " rad.";
      }
    }
  }
  return "";
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
  const std::string advice =
      " the configured load (setLoad; ROS: service set_load) and the thresholds "
      "(setCollisionBehavior; ROS: services set_force_torque_collision_behavior and "
      "set_full_collision_behavior, collision_config in the node's yaml file).";
  return text.empty() ? "the log does not show where. Check" + advice
                      : "a collision was detected at " + text +
                            ". These values are filtered: those that the robot compared with its "
                            "thresholds may have been larger. If nothing was touched, check" +
                            advice;
}

std::string Diagnosis::deviation() const {
  const RobotState& state = log_.back().state;
  return "the end effector was " + distance(state.O_T_EE, state.O_T_EE_d) +
         " away from its desired pose.";
}

std::string Diagnosis::lostPackets() const {
  double answer_time = 0.0;
  for (const AbortRecord& record : log_) {
    answer_time = std::max(answer_time, record.answer_time);
  }
  if (answer_time > kLongAnswer) {
    return "20 commands in a row came too late or not at all, because this program took " +
           number(answer_time) +
           " s to answer one state. Probably its control callback (or loop) calls something that "
           "blocks: a command of the hand (Gripper) or of the arm, a service, input and output, a "
           "lock. Call that from another thread. If it calls nothing of the kind, other programs "
           "had the processor: give the program a higher priority.";
  }
  const std::uint64_t lost = statesLost(log_);
  const double rate =
      log_.size() >= 2 ? log_[log_.size() - 2].state.control_command_success_rate : 0.0;
  return "20 commands in a row came too late or not at all; " + std::to_string(lost) +
         " states were lost before the last one, and " + number(100.0 * rate) +
         " % of the commands before had arrived. Check the real-time priority of this program, the "
         "time its callback takes, and the network (no switch, no wireless link, CPU frequency "
         "scaling off).";
}

std::string Diagnosis::startJoints() const {
  for (std::size_t i = 1; i < log_.size(); i++) {
    const std::array<double, 7>& q_d = log_[i - 1].state.q_d;
    const std::array<double, 7>& q_c = log_[i].command.q_c;
    if (isUsed(q_c)) {
      std::size_t farthest = 0;
      for (std::size_t j = 1; j < 7; j++) {
        if (std::abs(q_c[j] - q_d[j]) > std::abs(q_c[farthest] - q_d[farthest])) {
          farthest = j;
        }
      }
      return "the first command put " + jointName(farthest) + " at " + number(q_c[farthest]) +
             " rad while q_d was " + number(q_d[farthest]) + " rad. Begin at q_d.";
    }
  }
  return std::string(kNoFirstCommand) + " Begin at q_d.";
}

std::string Diagnosis::startPose() const {
  for (std::size_t i = 1; i < log_.size(); i++) {
    if (isUsed(log_[i].command.O_T_EE_c)) {
      return "the first commanded pose was " +
             distance(log_[i].command.O_T_EE_c, log_[i - 1].state.O_T_EE_c) +
             " away from O_T_EE_c. Begin at O_T_EE_c.";
    }
  }
  return std::string(kNoFirstCommand) + " Begin at O_T_EE_c.";
}

/// The record before the first or last command of an elbow: the next record's command answered its
/// state.
const AbortRecord* Diagnosis::elbowCommand(bool first) const {
  const AbortRecord* found = nullptr;
  for (std::size_t i = 1; i < log_.size() && !(first && found != nullptr); i++) {
    if (log_[i].command.valid_elbow) {
      found = &log_[i - 1];
    }
  }
  return found;
}

std::string Diagnosis::startElbow() const {
  const AbortRecord* const record = elbowCommand(true);
  if (record == nullptr) {
    return std::string(kNoFirstCommand) + " Begin at elbow_c.";
  }
  return "the first command had the elbow (joint 3) at " + number(record[1].command.elbow_c[0]) +
         " rad while elbow_c was " + number(record->state.elbow_c[0]) + " rad. Begin at elbow_c.";
}

std::string Diagnosis::elbowLimit() const {
  const AbortRecord* const last = elbowCommand(false);
  if (last != nullptr) {
    const double q3 = last[1].command.elbow_c[0];
    if (!(q3 >= limits_.q_min[2] && q3 <= limits_.q_max[2])) {
      return rangeOf({2, q3}, "was commanded, as the elbow, to", limits_);
    }
  }
  int order = 1;
  const std::optional<Excess> excess = measures_.commandedElbow(order);
  return excess ? commanded(excess, order) : "no command of the log has an elbow.";
}

std::string Diagnosis::elbowSign(bool first) const {
  const AbortRecord* const record = elbowCommand(first);
  if (record == nullptr) {
    return "no command of the log has an elbow. Its sign must be that of elbow_c.";
  }
  return std::string("the ") + (first ? "first " : "") + "commanded elbow has the sign " +
         number(record[1].command.elbow_c[1]) + " while the arm's was " +
         number(record->state.elbow_c[1]) + ". It changes where joint 4 passes " +
         number(kElbowFlip) + " rad, and must stay the same within a motion.";
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

std::string Diagnosis::invalidFrame() const {
  const std::string what = "a commanded pose was not a homogeneous transformation: ";
  for (auto record = log_.rbegin(); record != log_.rend(); ++record) {
    const std::string fault =
        isUsed(record->command.O_T_EE_c) ? transformFault(record->command.O_T_EE_c) : "";
    if (!fault.empty()) {
      return what + fault + ".";
    }
  }
  return what +
         "its rotation must be orthonormal, its last row 0 0 0 1, and it must be column-major.";
}

/// By the numbers of the flags (protocol 4.3).
std::string Diagnosis::explain(std::size_t flag) const {
  switch (static_cast<RobotError>(flag)) {
    case RobotError::kJointPositionLimitsViolation:
      return positionViolation();
    case RobotError::kJointVelocityViolation:
      return measuredVelocity();
    case RobotError::kJointReflex:
    case RobotError::kCartesianReflex:
      return collision();
    case RobotError::kMaxGoalPoseDeviationViolation:
    case RobotError::kMaxPathPoseDeviationViolation:
      return deviation();
    case RobotError::kJointPositionMotionGeneratorStartPoseInvalid:
      return startJoints();
    case RobotError::kJointMotionGeneratorPositionLimitsViolation:
      return rangeOf(commandedPosition(), kWasCommanded, limits_);
    case RobotError::kJointMotionGeneratorVelocityLimitsViolation:
      return commanded(measures_.commandedJoints(1), 1);
    case RobotError::kJointMotionGeneratorVelocityDiscontinuity:
      return commanded(measures_.commandedJoints(2), 2);
    case RobotError::kJointMotionGeneratorAccelerationDiscontinuity:
      return commanded(measures_.commandedJoints(3), 3);
    case RobotError::kCartesianPositionMotionGeneratorStartPoseInvalid:
      return startPose();
    case RobotError::kCartesianMotionGeneratorElbowLimitViolation:
      return elbowLimit();
    case RobotError::kCartesianMotionGeneratorVelocityLimitsViolation:
      return commanded(measures_.commandedTwist(1), 1);
    case RobotError::kCartesianMotionGeneratorVelocityDiscontinuity:
      return commanded(measures_.commandedTwist(2), 2);
    case RobotError::kCartesianMotionGeneratorAccelerationDiscontinuity:
      return commanded(measures_.commandedTwist(3), 3);
    case RobotError::kCartesianMotionGeneratorElbowSignInconsistent:
      return elbowSign(false);
    case RobotError::kCartesianMotionGeneratorStartElbowInvalid:
      return startElbow();
    case RobotError::kStartElbowSignInconsistent:
      return elbowSign(true);
    case RobotError::kCommunicationConstraintsViolation:
      return lostPackets();
    case RobotError::kCartesianMotionGeneratorJointPositionLimitsViolation:
      return rangeOf(solvedPosition(), kWouldHaveFollowed, limits_);
    case RobotError::kCartesianMotionGeneratorJointVelocityLimitsViolation:
      return solved(1);
    case RobotError::kCartesianMotionGeneratorJointVelocityDiscontinuity:
      return solved(2);
    case RobotError::kCartesianMotionGeneratorJointAccelerationDiscontinuity:
      return solved(3);
    case RobotError::kCartesianPositionMotionGeneratorInvalidFrameFlag:
      return invalidFrame();
    case RobotError::kControllerTorqueDiscontinuity:
      return commanded(measures_.commandedTorques(), "a change of torque", 1);
    case RobotError::kTauJRangeViolation:
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
