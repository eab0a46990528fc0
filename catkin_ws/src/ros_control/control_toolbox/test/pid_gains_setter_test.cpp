// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_toolbox/pid_gains_setter.h"

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <limits>
#include <stdexcept>

using control_toolbox::Pid;
using control_toolbox::PidGainsSetter;
using control_toolbox::SetPidGains;

TEST(PidGainsSetter, ServiceSetsAllPidsAndParameters) {
  Pid one(1.0);
  Pid other(2.0);
  PidGainsSetter setter;
  setter.add(&one).add(&other);
  setter.advertise("gains_setter_test");

  SetPidGains call;
  call.request.p = 3.0;
  call.request.i = 4.0;
  call.request.d = 5.0;
  call.request.i_clamp = -6.0;
  call.request.antiwindup = 1;
  ASSERT_TRUE(ros::service::waitForService("gains_setter_test/set_gains", 10000));
  ASSERT_TRUE(ros::service::call("gains_setter_test/set_gains", call));
  for (Pid* pid : {&one, &other}) {
    const Pid::Gains gains = pid->getGains();
    EXPECT_EQ(3.0, gains.p_gain_);
    EXPECT_EQ(4.0, gains.i_gain_);
    EXPECT_EQ(5.0, gains.d_gain_);
    EXPECT_EQ(6.0, gains.i_max_);
    EXPECT_EQ(-6.0, gains.i_min_);
    EXPECT_TRUE(gains.antiwindup_);
  }
  // A Pid that starts from these parameters has the same gains.
  Pid restarted;
  ASSERT_TRUE(restarted.initParam("gains_setter_test"));
  EXPECT_EQ(6.0, restarted.getGains().i_max_);
  EXPECT_EQ(5.0, restarted.getGains().d_gain_);
  EXPECT_TRUE(restarted.getGains().antiwindup_);
}

TEST(PidGainsSetter, RefusesNonFiniteGainsAsAWhole) {
  Pid pid(1.0, 2.0);
  PidGainsSetter setter;
  setter.add(&pid);
  setter.advertise("gains_setter_refuses");
  SetPidGains call;
  call.request.p = 3.0;
  call.request.d = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(setter.setGains(call.request, call.response));
  EXPECT_EQ(1.0, pid.getGains().p_gain_);
  EXPECT_FALSE(ros::param::has("gains_setter_refuses/p"));
}

TEST(PidGainsSetter, RefusesANullPointer) {
  PidGainsSetter setter;
  EXPECT_THROW(setter.add(nullptr), std::invalid_argument);
}
