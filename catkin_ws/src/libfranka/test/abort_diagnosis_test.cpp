// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka_core/abort_diagnosis.h"

#include <franka/errors.h>
#include <franka_core/diagnose_log.h>
#include <franka_core/error_names.h>
#include <franka_core/limits.h>
#include <gtest/gtest.h>

#include <string>

namespace franka_core {
namespace {

/// A log of joint positions that stand still, and then break a limit.
std::vector<AbortRecord> jointLog(std::size_t flag, const std::array<double, 7>& last_step) {
  std::vector<AbortRecord> log(4);
  for (std::size_t i = 0; i < log.size(); i++) {
    log[i].state.message_id = 100 + i;
    log[i].state.q_d = log[i].state.q = {{0.1, 0.2, 0.3, -1.5, 0.5, 1.6, 0.7}};
    log[i].command.q_c = log[i].state.q_d;
    log[i].state.O_T_EE = log[i].state.O_T_EE_d =
        log[i].state.O_T_EE_c = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    log[i].state.control_command_success_rate = 0.97;
  }
  for (std::size_t i = 0; i < 7; i++) {
    log.back().command.q_c[i] += last_step[i];
  }
  log.back().state.reflex_reason[flag] = true;
  return log;
}

std::string only(const std::vector<std::string>& sentences) {
  EXPECT_EQ(1u, sentences.size());
  return sentences.empty() ? "" : sentences.front();
}

void expectIn(const std::string& text, const std::string& part) {
  EXPECT_NE(std::string::npos, text.find(part)) << text << "\nlacks: " << part;
}

TEST(AbortDiagnosis, NothingIsSaidAboutNothing) {
  EXPECT_TRUE(diagnoseAbort({}, 5).empty());
  EXPECT_TRUE(diagnoseAbort(std::vector<AbortRecord>(3), 5).empty());
}

TEST(AbortDiagnosis, NamesTheJointTheValueAndTheLimit) {
  // 3 mrad in a millisecond: 3 rad/s, 3000 rad/s^2, 3e6 rad/s^3; Panda's third joint may 2.175.
  const std::array<double, 7> step{{0, 0, 0.003, 0, 0, 0.001, 0}};
  std::string text = only(diagnoseAbort(jointLog(13, step), 5));
  expectIn(text, "joint_motion_generator_velocity_limits_violation: joint 3");
  expectIn(text, "a velocity of 3 rad/s, and 2.175 are allowed (at 102 ms)");
  text = only(diagnoseAbort(jointLog(14, step), 5));
  expectIn(text, "joint_motion_generator_velocity_discontinuity: joint 3");
  expectIn(text, "an acceleration of 3000 rad/s^2, and 10 are allowed");
  text = only(diagnoseAbort(jointLog(15, step), 5));
  expectIn(text, "a jerk of 3e+06 rad/s^3, and 5000 are allowed");
}

TEST(AbortDiagnosis, TheLimitsAreThoseOfTheRobot) {
  const std::array<double, 7> step{{0, 0.003, 0, 0, 0, 0, 0}};
  expectIn(only(diagnoseAbort(jointLog(14, step), 5)), "and 7.5 are allowed");
  expectIn(only(diagnoseAbort(jointLog(14, step), 10)), "and 10 are allowed");
  // An FR3's velocity limit depends on where the joint stands.
  const double limit = upperVelocityLimit(kFr3PositionVelocityLimits, 1, 0.2);
  const std::string text = only(diagnoseAbort(jointLog(13, step), 7));
  expectIn(text, "joint 2 was commanded a velocity of 3 rad/s");
  char allowed[32];
  std::snprintf(allowed, sizeof(allowed), "and %.4g are", limit);
  expectIn(text, allowed);
}

TEST(AbortDiagnosis, PositionsOutsideTheRange) {
  auto log = jointLog(12, {{0, 0, 0, 2.0, 0, 0, 0}});
  expectIn(only(diagnoseAbort(log, 5)),
           "joint 4 was to go to 0.5 rad, and its range is -3.072 to -0.0698 rad");
  log.back().state.reflex_reason = {};
  log.back().state.reflex_reason[0] = true;
  log.back().state.q[5] = 4.0;
  expectIn(only(diagnoseAbort(log, 5)), "joint 6 stood at 4 rad");
}

TEST(AbortDiagnosis, TorquesThatChangeTooFast) {
  auto log = jointLog(32, {});
  log.back().command.tau_J_d[6] = -1.5;
  expectIn(only(diagnoseAbort(log, 5)),
           "joint 7 was commanded a change of torque of -1500 Nm/s, and 1000 are allowed");
}

TEST(AbortDiagnosis, PosesThatJump) {
  auto log = jointLog(18, {});
  for (AbortRecord& record : log) {
    record.command.q_c = {};
    record.command.O_T_EE_c = record.state.O_T_EE_c;
  }
  log.back().command.O_T_EE_c[12] = 0.004;  // 4 m/s
  expectIn(only(diagnoseAbort(log, 5)),
           "the translation was commanded a velocity of 4 m/s or rad/s, and 2 are allowed");
  // Turned by 5 mrad about z: 5 rad/s.
  log.back().command.O_T_EE_c = {{std::cos(0.005), std::sin(0.005), 0, 0, -std::sin(0.005),
                                  std::cos(0.005), 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  expectIn(only(diagnoseAbort(log, 5)), "the rotation was commanded a velocity of 5 m/s or rad/s");
}

TEST(AbortDiagnosis, CollisionsWithTheirForces) {
  auto log = jointLog(7, {});
  log.back().state.cartesian_collision[2] = 1.0;
  log.back().state.O_F_ext_hat_K[2] = -31.5;
  log.back().state.joint_collision[3] = 1.0;
  log.back().state.tau_ext_hat_filtered[3] = 22.0;
  const std::string text = only(diagnoseAbort(log, 5));
  expectIn(text, "joint 4 (external torque 22 Nm), z (external force -31.5 N)");
  expectIn(text, "setLoad");
}

TEST(AbortDiagnosis, LostPackets) {
  auto log = jointLog(25, {});
  log.back().state.message_id += 7;
  EXPECT_EQ(7u, statesLost(log));
  const std::string text = only(diagnoseAbort(log, 5));
  expectIn(text, "7 states were lost before the last one");
  expectIn(text, "97 % of the commands");
}

TEST(AbortDiagnosis, StartsElsewhere) {
  auto log = jointLog(11, {});
  log[1].command.q_c[4] = 0.9;
  expectIn(only(diagnoseAbort(log, 5)),
           "the first command put joint 5 at 0.9 rad while q_d was 0.5 rad");
}

TEST(AbortDiagnosis, EveryFlagHasASentence) {
  for (std::size_t flag = 0; flag < kErrorCount; flag++) {
    const std::string text = only(diagnoseAbort(jointLog(flag, {}), 10));
    EXPECT_EQ(0u, text.find(kErrorNames[flag]));
    EXPECT_EQ('.', text.back()) << text;
  }
}

TEST(AbortDiagnosis, ReadsTheLogOfUsersToo) {
  const auto log = jointLog(14, {{0, 0, 0.003, 0, 0, 0, 0}});
  std::vector<franka::Record> records(log.size());
  for (std::size_t i = 0; i < log.size(); i++) {
    records[i].state.time = franka::Duration(log[i].state.message_id);
    records[i].state.q_d = log[i].state.q_d;
    records[i].command.joint_positions.q = log[i].command.q_c;
  }
  records.back().state.last_motion_errors = franka::Errors(log.back().state.reflex_reason);
  EXPECT_EQ(only(diagnoseAbort(log, 5)), only(diagnoseLog(records, 5)));
}

}  // namespace
}  // namespace franka_core
