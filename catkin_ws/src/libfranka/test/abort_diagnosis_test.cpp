// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka_core/abort_diagnosis.h"

#include <franka/errors.h>
#include <franka_core/diagnose_log.h>
#include <franka_core/limits.h>
#include <franka_core/numbers.h>
#include <franka_core/robot_error.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace franka_core {
namespace {

constexpr std::array<double, 16> kNoTurn{{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};

/// A log of constant joint positions followed by a step that violates a limit.
std::vector<AbortRecord> jointLog(std::size_t flag, const std::array<double, 7>& last_step) {
  std::vector<AbortRecord> log(4);
  for (std::size_t i = 0; i < log.size(); i++) {
    log[i].state.message_id = 100 + i;
    log[i].state.q_d = log[i].state.q = {{0.1, 0.2, 0.3, -1.5, 0.5, 1.6, 0.7}};
    log[i].command.q_c = log[i].state.q_d;
    log[i].state.O_T_EE = log[i].state.O_T_EE_d = log[i].state.O_T_EE_c = kNoTurn;
    log[i].state.control_command_success_rate = 0.97;
  }
  for (std::size_t i = 0; i < 7; i++) {
    log.back().command.q_c[i] += last_step[i];
  }
  log.back().state.reflex_reason[flag] = true;
  return log;
}

/// Rotated about z [rad], and shifted along x [m].
std::array<double, 16> pose(double angle, double x) {
  return {{std::cos(angle), std::sin(angle), 0, 0, -std::sin(angle), std::cos(angle), 0, 0, 0, 0, 1,
           0, x, 0, 0, 1}};
}

/// A log of poses and elbows, all at rest. In the last state the robot brakes.
std::vector<AbortRecord> cartesianLog(std::size_t flag) {
  std::vector<AbortRecord> log = jointLog(flag, {});
  for (AbortRecord& record : log) {
    record.command.q_c = {};
    record.command.O_T_EE_c = kNoTurn;
    record.command.elbow_c = record.state.elbow_c = {{0.3, -1.0}};
  }
  log.back().command.valid_elbow = true;
  log.back().state.dq_d.fill(5.0);
  log.back().state.ddq_d.fill(-20.0);
  return log;
}

/// The same with joints that follow: joint 4 accelerates in steps of 1 rad/s^2.
std::vector<AbortRecord> followingLog(std::size_t flag) {
  std::vector<AbortRecord> log = cartesianLog(flag);
  const double q[]{-0.074334, -0.072173, -0.07};
  const double dq[]{2.15, 2.161, 2.173};
  const double ddq[]{10.0, 11.0, 12.0};
  for (std::size_t i = 0; i < 3; i++) {
    log[i].state.q_d[3] = q[i];
    log[i].state.dq_d[3] = dq[i];
    log[i].state.ddq_d[3] = ddq[i];
  }
  return log;
}

std::string only(const std::vector<std::string>& sentences) {
  EXPECT_EQ(1u, sentences.size());
  return sentences.empty() ? "" : sentences.front();
}

void expectIn(const std::string& text, const std::string& part) {
  EXPECT_NE(std::string::npos, text.find(part)) << text << "\nlacks: " << part;
}

TEST(AbortDiagnosis, AnEmptyLogGivesNoSentence) {
  EXPECT_TRUE(diagnoseAbort({}, 5).empty());
  EXPECT_TRUE(diagnoseAbort(std::vector<AbortRecord>(3), 5).empty());
}

using Log = std::vector<AbortRecord>;

template <typename Change>
Log changed(Log log, Change change) {
  change(log);
  return log;
}

TEST(AbortDiagnosis, NamesTheJointTheValueAndTheLimit) {
  // 3 mrad in a millisecond: 3 rad/s, 3000 rad/s^2, 3e6 rad/s^3.
  const std::array<double, 7> step{{0, 0, 0.003, 0, 0, 0.001, 0}};
  const std::array<double, 7> step2{{0, 0.003, 0, 0, 0, 0, 0}};
  const std::string fr3_limit =
      numberText(upperVelocityLimit(kFr3PositionVelocityLimits, 1, 0.2), 4);
  struct Row {
    Log log;
    unsigned version;
    std::string part;
  };
  const Row rows[] = {
      {jointLog(13, step), 5, "joint_motion_generator_velocity_limits_violation: joint 3"},
      {jointLog(13, step), 5, "of 3 rad/s; the limit is 2.175 (1 ms before the end of the log)"},
      {jointLog(14, step), 5, "joint_motion_generator_velocity_discontinuity: joint 3"},
      {jointLog(14, step), 5, "an acceleration of 3000 rad/s^2; the limit is 10"},
      {jointLog(15, step), 5, "a jerk of 3e+06 rad/s^3; the limit is 5000"},
      {jointLog(14, step2), 5, "the limit is 7.5"},
      {jointLog(14, step2), 10, "the limit is 10"},
      // An FR3's velocity limit depends on the joint's position, and is 0 at the ends.
      {jointLog(13, step2), 7, "a velocity of 3 rad/s; the limit is " + fr3_limit},
      {changed(jointLog(13, {{0, 0, 0, 0.0005, 0, 0, 0}}),
               [](Log& log) {
                 for (AbortRecord& record : log) {
                   record.command.q_c[3] += kFr3Limits.q_max[3] - record.state.q_d[3];
                   record.state.q_d[3] = kFr3Limits.q_max[3];
                 }
               }),
       10, "joint 4 was commanded a velocity of 0.5 rad/s; the limit is 0"},
      // Joint 1 of an FR3 ends at 2.9007 rad; its velocity limit is 0 from 2.8644 rad on.
      {jointLog(0, {{2.79, 0, 0, 0, 0, 0, 0}}), 10, "is 0 outside of -2.864 to 2.864 rad"},
      {jointLog(12, {{0, 0, 0, 2.0, 0, 0, 0}}), 5,
       "joint 4 was commanded to 0.5 rad, and its range is -3.072 to -0.0698 rad"},
      // Newer systems use this flag for commands too.
      {jointLog(0, {{0, 0, 0, 2.0, 0, 0, 0}}), 10, "joint 4 was commanded to 0.5 rad"},
      {followingLog(0), 10, "joint 4 would have followed the Cartesian command to -0.06781 rad"},
      {changed(jointLog(0, {}), [](Log& log) { log.back().state.q[5] = 4.0; }), 5,
       "joint 6 stood at 4 rad"},
      {changed(jointLog(3, {}), [](Log& log) { log.back().state.dq[6] = -2.8; }), 5,
       "joint 7 moved at -2.8 rad/s; the limit is 2.61 (0 ms before the end of the log)"},
      {changed(jointLog(32, {}), [](Log& log) { log.back().command.tau_J_d[6] = -1.5; }), 5,
       "joint 7 was commanded a change of torque of -1500 Nm/s; the limit is 1000"},
      {changed(jointLog(11, {}), [](Log& log) { log[1].command.q_c[4] = 0.9; }), 5,
       "the first command put joint 5 at 0.9 rad while q_d was 0.5 rad"},
  };
  for (const Row& row : rows) {
    expectIn(only(diagnoseAbort(row.log, row.version)), row.part);
  }
}

TEST(AbortDiagnosis, NamesTheFaultOfAPose) {
  struct Row {
    std::size_t flag;
    std::size_t record;  // of the command
    std::array<double, 16> pose;
    const char* part;
  };
  std::array<double, 16> invalid = kNoTurn;
  invalid[3] = 1e-17;
  const Row rows[] = {
      {31, 3, invalid, "is 1e-17 0 0 1 and must be exactly 0 0 0 1"},
      {18, 3, pose(0.0, 0.004),
       "the translation was commanded a velocity of 4 m/s; the limit is 2"},
      {18, 3, pose(0.005, 0.0),
       "the rotation was commanded a velocity of 5 rad/s; the limit is 2.5"},
      {19, 3, pose(0.005, 0.0), "an acceleration of 5000 rad/s^2; the limit is 25"},
      {16, 1, pose(M_PI / 60.0, 0.002), "pose was 2 mm and 3 degrees away from O_T_EE_c"},
  };
  for (const Row& row : rows) {
    Log log = cartesianLog(row.flag);
    log[row.record].command.O_T_EE_c = row.pose;
    expectIn(only(diagnoseAbort(log, 5)), row.part);
  }
}

TEST(AbortDiagnosis, JointsThatFollowACartesianCommand) {
  // Continued with 1000 rad/s^3: 13 rad/s^2, 2.173 + 0.013 rad/s, -0.07 + 0.002186 rad.
  const std::string text = only(diagnoseAbort(followingLog(28), 5));
  expectIn(text,
           "joint 4 would have followed the Cartesian command with a velocity of 2.186 rad/s; the "
           "limit is 2.175 (0 ms before the end of the log).");
  expectIn(text, "singular");
  expectIn(only(diagnoseAbort(followingLog(29), 5)),
           "joint 4 would have followed the Cartesian command with an acceleration of 13 rad/s^2; "
           "the limit is 12.5 (0 ms before the end of the log)");
  expectIn(only(diagnoseAbort(followingLog(27), 5)),
           "joint 4 would have followed the Cartesian command to -0.06781 rad, and its range is "
           "-3.072 to -0.0698 rad");
  auto log = followingLog(30);
  log[2].state.ddq_d[3] = 18.5;
  expectIn(only(diagnoseAbort(log, 5)),
           "joint 4 would have followed the Cartesian command with a jerk of 7500 rad/s^3; the "
           "limit is 6250 (1 ms before the end of the log)");
  // Over three milliseconds, with two states lost.
  log[2].state.message_id = 104;
  expectIn(only(diagnoseAbort(log, 5)), "a jerk of 2500 rad/s^3");
}

TEST(AbortDiagnosis, ElbowVelocities) {
  auto log = cartesianLog(17);
  for (AbortRecord& record : log) {
    record.state.delbow_c[0] = 1.0;
  }
  const auto message = [&log](double q3, unsigned version) {
    log.back().command.elbow_c[0] = q3;
    return only(diagnoseAbort(log, version));
  };
  expectIn(message(0.3025, 5),
           "the elbow (joint 3) was commanded a velocity of 2.5 rad/s; the limit is 2.175 (1 ms "
           "before the end of the log)");
  // The lowest derivative that is too high, in the robot's order.
  expectIn(message(0.3025, 10), "an acceleration of 1500 rad/s^2; the limit is 10");
  expectIn(message(0.30102, 5), "an acceleration of 20 rad/s^2; the limit is 10");
  expectIn(message(0.301006, 5), "a jerk of 6000 rad/s^3; the limit is 5000");
  expectIn(message(0.30100500005, 5), "a jerk of 5000.1 rad/s^3; the limit is 5000");
  expectIn(message(3.0, 5),
           "joint 3 was commanded, as the elbow, to 3 rad, and its range is -2.897 to 2.897 rad");
  expectIn(message(2.89731, 5),
           "joint 3 was commanded, as the elbow, to 2.89731 rad, and its range is -2.8973 to "
           "2.8973 rad");
  log.back().command.valid_elbow = false;
  expectIn(message(0.0, 5), "no command of the log has an elbow");
}

TEST(AbortDiagnosis, ElbowSignsAndStarts) {
  const auto flip = [](Log& log) { log.back().command.elbow_c[1] = 1.0; };
  for (std::size_t flag : {21u, 24u}) {
    expectIn(only(diagnoseAbort(changed(cartesianLog(flag), flip), 5)),
             "commanded elbow has the sign 1 while the arm's was -1");
  }
  const auto start = [](Log& log) { log.back().command.elbow_c[0] = 0.9; };
  expectIn(only(diagnoseAbort(changed(cartesianLog(22), start), 5)),
           "the first command had the elbow (joint 3) at 0.9 rad while elbow_c was 0.3 rad");
}

TEST(AbortDiagnosis, CollisionsNameTheirForces) {
  auto log = jointLog(7, {});
  log.back().state.cartesian_collision[2] = 1.0;
  log.back().state.O_F_ext_hat_K[2] = -31.5;
  log.back().state.joint_collision[3] = 1.0;
  log.back().state.tau_ext_hat_filtered[3] = 22.0;
  const std::string text = only(diagnoseAbort(log, 5));
  expectIn(text, "joint 4 (external torque 22 Nm), z (external force -31.5 N)");
  for (const char* word : {"filtered", "setLoad", "set_load", "collision_config"}) {
    expectIn(text, word);
  }
}

TEST(AbortDiagnosis, LostPackets) {
  auto log = jointLog(25, {});
  log.back().state.message_id += 7;
  EXPECT_EQ(7u, statesLost(log));
  const std::string text = only(diagnoseAbort(log, 5));
  expectIn(text, "7 states were lost before the last one");
  expectIn(text, "97 % of the commands");
}

TEST(AbortDiagnosis, ABlockedCallbackIsTheCauseOfLostPackets) {
  auto log = jointLog(25, {});
  log[1].answer_time = 33.0;
  const std::string text = only(diagnoseAbort(log, 5));
  expectIn(text, "33 s");
  expectIn(text, "blocks");
  EXPECT_EQ(std::string::npos, text.find("network")) << text;
  log[1].answer_time = 0.001;
  expectIn(only(diagnoseAbort(log, 5)), "network");
}

TEST(AbortDiagnosis, EveryFlagHasASentence) {
  const std::set<std::size_t> in_no_log{1, 2, 4, 5, 10, 23, 26, 33, 35, 36, 37, 38, 39, 40};
  for (std::size_t flag = 0; flag < kErrorCount; flag++) {
    const bool is_cartesian = (flag >= 16 && flag <= 24) || (flag >= 27 && flag <= 31);
    const std::string text =
        only(diagnoseAbort(is_cartesian ? followingLog(flag) : jointLog(flag, {}), 10));
    EXPECT_EQ(0u, text.find(kErrorNames[flag]));
    EXPECT_EQ('.', text.back()) << text;
    EXPECT_EQ(in_no_log.count(flag) == 1, text.find("see the robot's manual") != std::string::npos)
        << text;
    for (const char* const missing : {"the log shows no", "too short", "the log does not hold"}) {
      EXPECT_EQ(std::string::npos, text.find(missing)) << text;
    }
  }
}

TEST(AbortDiagnosis, ReportsAnIncompleteLog) {
  std::vector<AbortRecord> log(1);
  for (std::size_t flag = 0; flag < kErrorCount; flag++) {
    log.back().state.reflex_reason = {};
    log.back().state.reflex_reason[flag] = true;
    EXPECT_EQ('.', only(diagnoseAbort(log, 5)).back()) << flag;
  }
  log.back().state.reflex_reason = {};
  log.back().state.reflex_reason[13] = true;
  expectIn(only(diagnoseAbort(log, 5)),
           "the log shows no commands from which a velocity could be computed");
}

TEST(AbortDiagnosis, ReadsPublicLogs) {
  const auto accelerate = [](Log& log) {
    log.back().command.elbow_c[0] = 0.301006;
    for (AbortRecord& record : log) {
      record.state.delbow_c[0] = 0.9;
      record.state.ddelbow_c[0] = 100.0;
    }
  };
  const Log elbow_log = changed(cartesianLog(17), accelerate);
  expectIn(only(diagnoseAbort(elbow_log, 5)), "an acceleration of 106 rad/s^2");
  for (const Log& log : {jointLog(14, {{0, 0, 0.003, 0, 0, 0, 0}}), elbow_log}) {
    std::vector<franka::Record> records(log.size());
    for (std::size_t i = 0; i < log.size(); i++) {
      records[i].state.time = franka::Duration(log[i].state.message_id);
      records[i].state.q_d = log[i].state.q_d;
      records[i].state.elbow_c = log[i].state.elbow_c;
      records[i].state.delbow_c = log[i].state.delbow_c;
      records[i].state.ddelbow_c = log[i].state.ddelbow_c;
      records[i].command.joint_positions.q = log[i].command.q_c;
    }
    records.back().command.cartesian_pose.elbow = log.back().command.elbow_c;
    records.back().state.last_motion_errors = franka::Errors(log.back().state.reflex_reason);
    EXPECT_EQ(only(diagnoseAbort(log, 5)), only(diagnoseLog(records, 5)));
  }
}

}  // namespace
}  // namespace franka_core
