// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The hand's fingers: their ramp, their force, and when they stand still.
#include <franka_sim/robot/hands/finger_force.h>
#include <franka_sim/robot/hands/standstill.h>
#include <franka_sim/robot/hands/ticket_log.h>
#include <franka_sim/robot/hands/width_ramp.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace franka_sim::test {

namespace {

TEST(WidthRamp, MovesAtItsSpeedAndEndsExactly) {
  for (const double speed : {0.0007, 0.02, 0.1}) {
    for (const double target : {0.0, 0.0300001, 0.08}) {
      WidthRamp ramp;
      ramp.start(0.03, target, speed);
      double last = 0.03;
      double fastest = 0.0;
      int ticks = 0;
      while (!ramp.arrived() && ticks < 200000) {
        ramp.step(1e-3);
        const double step = std::abs(ramp.width() - last) / 1e-3;
        fastest = std::max(fastest, step);
        last = ramp.width();
        EXPECT_GE(ramp.width(), std::min(0.03, target));
        EXPECT_LE(ramp.width(), std::max(0.03, target));
        ticks++;
      }
      EXPECT_EQ(target, ramp.width());
      EXPECT_EQ(0.0, ramp.velocity());
      EXPECT_LE(fastest, speed * (1 + 1e-9));
      const double way = std::abs(target - 0.03);
      const double expected = way > speed * speed ? way / speed + speed : 2.0 * std::sqrt(way);
      EXPECT_NEAR(expected, 1e-3 * ticks, 0.01 + 0.01 * expected) << speed << " " << target;
    }
  }
}

/// Whether the fingers stand still after each of these velocities; a threshold of 0.001 m/s.
std::vector<bool> standStill(Standstill& standstill, const std::vector<double>& velocities) {
  std::vector<bool> still;
  for (const double velocity : velocities) {
    still.push_back(standstill.update(velocity, 0.001, 1e-3));
  }
  return still;
}

TEST(Standstill, CountsThreeTicksAfterMotionOrTheTimeout) {
  Standstill standstill(3);
  standstill.restart();
  EXPECT_EQ((std::vector<bool>{false, false, false, false, false, false, true}),
            standStill(standstill, {0, 0, 0, 0.002, 0.001, -0.001, 0}));
  standstill.restart();
  standstill.countFromNow();
  EXPECT_EQ((std::vector<bool>{false, false, false, false, false, true}),
            standStill(standstill, {0, 0, 0.01, 0, 0, 0}));
  standstill.restart();
  const std::vector<bool> without_motion = standStill(standstill, std::vector<double>(250, 0.0));
  EXPECT_NEAR(
      202,
      std::find(without_motion.begin(), without_motion.end(), true) - without_motion.begin() + 1,
      1);
}

TEST(FingerForce, LimitsTheIntegral) {
  FingerForce finger({100, 50, 1});
  EXPECT_NEAR(1 + 50 * 0.01 * 1e-3 + 8 * 0.5, finger.update(0.01, 0.5, 1e-3), 1e-12);
  for (int i = 0; i < 1000000; i++) {
    finger.update(0.04, 0, 1e-3);
  }
  EXPECT_NEAR(4 + 10, finger.update(0.04, 0, 1e-3), 1e-12);
  finger.restart();
  EXPECT_NEAR(0.0, finger.update(0, 0, 1e-3), 1e-12);
}

TEST(TicketLog, KeepsSixteenOutcomes) {
  TicketLog log;
  EXPECT_EQ(GripperOutcome::kFailed, log.outcome(0));
  EXPECT_EQ(GripperOutcome::kFailed, log.outcome(1));
  log.close(GripperOutcome::kSucceeded);  // nothing runs
  const TicketLog::Ticket first = log.open();
  EXPECT_EQ(1u, first);
  EXPECT_EQ(GripperOutcome::kRunning, log.outcome(first));
  const TicketLog::Ticket second = log.open();
  EXPECT_EQ(GripperOutcome::kInterrupted, log.outcome(first));
  log.close(GripperOutcome::kSucceeded);
  log.close(GripperOutcome::kFailed);  // has already ended
  EXPECT_EQ(GripperOutcome::kSucceeded, log.outcome(second));
  for (std::size_t i = 0; i < TicketLog::kRemembered - 1; i++) {
    log.open();
  }
  EXPECT_EQ(GripperOutcome::kSucceeded, log.outcome(second));
  log.open();
  EXPECT_EQ(GripperOutcome::kInterrupted, log.outcome(second)) << "forgotten";
  EXPECT_EQ(GripperOutcome::kFailed, log.outcome(100));
}

TEST(TicketLog, TakesOverAnEarlierStateWithoutGivingANumberTwice) {
  TicketLog log;
  const TicketLog::Ticket first = log.open();
  const TicketLog earlier = log;
  log.close(GripperOutcome::kSucceeded);
  const TicketLog::Ticket second = log.open();
  log = earlier;
  EXPECT_EQ(GripperOutcome::kRunning, log.outcome(first));
  EXPECT_EQ(GripperOutcome::kInterrupted, log.outcome(second));
  EXPECT_TRUE(log.isOpen());
  log.close(GripperOutcome::kFailed);
  EXPECT_EQ(GripperOutcome::kFailed, log.outcome(first));
  EXPECT_LT(second, log.open());
}

TEST(TicketLog, TakesOverTheLogOfAnotherHandUnderNewNumbers) {
  TicketLog log;
  TicketLog other;
  const TicketLog::Ticket own = log.open();
  ASSERT_EQ(own, other.open());
  log = other;
  log.renumber();
  EXPECT_TRUE(log.isOpen());
  EXPECT_EQ(GripperOutcome::kInterrupted, log.outcome(own));
  log.close(GripperOutcome::kSucceeded);
  EXPECT_EQ(GripperOutcome::kInterrupted, log.outcome(own));
  TicketLog empty;
  log = empty;
  log.renumber();
  EXPECT_FALSE(log.isOpen());
}

}  // namespace

}  // namespace franka_sim::test
