// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime_tools/realtime_clock.h"

#include <gtest/gtest.h>
#include <ros/time.h>
#include <ros_test/eventually.h>
#include <rt_guard/rt_guard.h>

#include <cmath>

using realtime_tools::RealtimeClock;

namespace {

/// The test sets the system's time.
class RealtimeClockTest : public testing::Test {
 protected:
  RealtimeClockTest() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(2000.0));
  }
};

}  // namespace

TEST_F(RealtimeClockTest, ItsThreadSamples) {
  RealtimeClock clock;
  EXPECT_TRUE(ros_test::eventually(
      [&] { return std::abs(clock.getSystemTime(ros::Time(100.0)).toSec() - 2000.0) < 1e-6; }));
}

TEST_F(RealtimeClockTest, AddsTheDifferenceOfTheClocks) {
  RealtimeClock clock;
  clock.sample();
  EXPECT_NEAR(2000.0, clock.getSystemTime(ros::Time(100.0)).toSec(), 1e-6);
  EXPECT_NEAR(2000.5, clock.getSystemTime(ros::Time(100.5)).toSec(), 1e-6);
}

TEST_F(RealtimeClockTest, FirstNoteCountsFromTheMiddleOfTheCycle) {
  ros::Time::setNow(ros::Time(0.0));  // as before the first /clock: no sample yet
  RealtimeClock clock;
  clock.sample();
  EXPECT_EQ(100.0, clock.getSystemTime(ros::Time(100.0)).toSec());
  ros::Time::setNow(ros::Time(2000.0));
  clock.sample();
  // 2000 was sampled between 100.0 and 100.2, so 100.1 is 2000 and 100.2 is 2000.1.
  EXPECT_NEAR(2000.1, clock.getSystemTime(ros::Time(100.2)).toSec(), 1e-6);
}

TEST_F(RealtimeClockTest, FollowsALaterDifferenceByOneTenThousandthPerNote) {
  RealtimeClock clock;
  clock.sample();
  clock.getSystemTime(ros::Time(100.0));
  double offset = 1900.0;
  double last = 100.0;
  for (int i = 1; i <= 5; ++i) {
    const double realtime = 100.0 + i;
    const double system = 2000.0 + 3.0 * i;
    ros::Time::setNow(ros::Time(system));
    clock.sample();
    offset += 1e-4 * (system + 0.5 * (realtime - last) - realtime - offset);
    last = realtime;
    EXPECT_NEAR(realtime + offset, clock.getSystemTime(ros::Time(realtime)).toSec(), 1e-6);
  }
}

TEST_F(RealtimeClockTest, WithoutAFreshNoteTheDifferenceStays) {
  RealtimeClock clock;
  clock.sample();
  for (int i = 0; i < 1000; ++i) {
    const double realtime = 100.0 + 0.001 * i;
    EXPECT_NEAR(realtime + 1900.0, clock.getSystemTime(ros::Time(realtime)).toSec(), 1e-6);
  }
}

TEST_F(RealtimeClockTest, NeverReturnsATimeBeforeTheEpoch) {
  ros::Time::setNow(ros::Time(1.0));
  RealtimeClock clock;
  clock.sample();
  EXPECT_NEAR(1.0, clock.getSystemTime(ros::Time(100.0)).toSec(), 1e-6);
  EXPECT_EQ(50.0, clock.getSystemTime(ros::Time(50.0)).toSec());
}

TEST_F(RealtimeClockTest, ReadsWithoutAllocationOrLock) {
  RealtimeClock clock;
  clock.sample();
  rt_guard::Scope scope;
  for (int i = 0; i < 1000; ++i) {
    clock.getSystemTime(ros::Time(100, 1000 * i));
  }
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}
