// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/trigger_rate.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace franka_hw {
namespace {

/// How often a trigger fires in one simulated second of a 1 kHz loop.
int firesInOneSecond(TriggerRate& trigger, int first_millisecond) {
  int fires = 0;
  for (int i = 1; i <= 1000; ++i) {
    ros::Time now;
    now.fromNSec(static_cast<std::uint64_t>(first_millisecond + i) * 1000000U);
    fires += trigger(now) ? 1 : 0;
  }
  return fires;
}

TEST(TriggerRate, DeliversTheRequestedRate) {
  for (double rate : {1.0, 30.0, 250.0, 300.0, 999.0, 1000.0, 1e6}) {
    TriggerRate trigger(rate, ros::Time(0.5));
    EXPECT_EQ(std::min(rate, 1000.0), firesInOneSecond(trigger, 500)) << rate;
  }
}

TEST(TriggerRate, DoesNotCatchUpAfterAPause) {
  TriggerRate trigger(30.0, ros::Time(1.0));
  EXPECT_TRUE(trigger(ros::Time(100.0)));
  EXPECT_FALSE(trigger(ros::Time(100.001)));
}

TEST(TriggerRate, StartsAgainWhenTimeJumpsBack) {
  TriggerRate trigger(10.0, ros::Time(100.0));
  EXPECT_FALSE(trigger(ros::Time(1.0)));
  EXPECT_FALSE(trigger(ros::Time(1.05)));
  EXPECT_TRUE(trigger(ros::Time(1.1)));
}

TEST(TriggerRate, UsesRosTimeWithoutAnArgument) {
  ros::Time::setNow(ros::Time(5.0));
  TriggerRate trigger(10.0);
  ros::Time::setNow(ros::Time(5.09));
  EXPECT_FALSE(trigger());
  ros::Time::setNow(ros::Time(5.1));
  EXPECT_TRUE(trigger());
  EXPECT_FALSE(trigger());
}

TEST(TriggerRate, RefusesInvalidRates) {
  for (double rate : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                      std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(TriggerRate(rate, ros::Time(1.0)), std::invalid_argument) << rate;
  }
}

}  // namespace
}  // namespace franka_hw
