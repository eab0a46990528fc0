// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <dynamic_reconfigure/Reconfigure.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <ros_test/eventually.h>
#include <tinyxml.h>

#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "control_toolbox/pid.h"

using control_toolbox::Pid;
using ros_test::eventually;

namespace {

/// Expects the gains p, i, d, i_max, i_min.
void expectGains(Pid& pid, const std::vector<double>& expected, bool antiwindup) {
  const Pid::Gains gains = pid.getGains();
  const std::vector<double> actual{gains.p_gain_, gains.i_gain_, gains.d_gain_, gains.i_max_,
                                   gains.i_min_};
  EXPECT_EQ(expected, actual);
  EXPECT_EQ(antiwindup, gains.antiwindup_);
}

/// Changes one number by the reconfigure server in `ns`. @return the server's resulting values.
dynamic_reconfigure::Config reconfigure(const std::string& ns, const std::string& name,
                                        double value) {
  dynamic_reconfigure::Reconfigure call;
  if (!name.empty()) {
    call.request.config.doubles.resize(1);
    call.request.config.doubles[0].name = name;
    call.request.config.doubles[0].value = value;
  }
  EXPECT_TRUE(ros::service::call(ns + "/set_parameters", call));
  return call.response.config;
}

double numberIn(const dynamic_reconfigure::Config& config, const std::string& name) {
  for (const auto& number : config.doubles) {
    if (number.name == name) {
      return number.value;
    }
  }
  ADD_FAILURE() << "no number " << name;
  return 0.0;
}

std::string ns(const std::string& name) { return ros::NodeHandle("~").getNamespace() + "/" + name; }

}  // namespace

TEST(PidParameters, ReadsAllGains) {
  Pid pid;
  ASSERT_TRUE(pid.initParam(ns("full")));
  expectGains(pid, {3.0, 2.0, 1.0, 5.0, -5.0}, true);
}

TEST(PidParameters, SideLimitsOverrideTheCommonOneForAnySign) {
  Pid pid;
  ASSERT_TRUE(pid.initParam(ns("sides")));
  expectGains(pid, {1.0, 0.0, 0.0, 4.0, -3.0}, false);
}

TEST(PidParameters, OnlyPIsRequired) {
  Pid pid;
  ASSERT_TRUE(pid.init(ros::NodeHandle("~only_p")));
  expectGains(pid, {7.5, 0.0, 0.0, 0.0, 0.0}, false);
  EXPECT_FALSE(pid.initParam(ns("empty")));
  EXPECT_FALSE(pid.initParam(ns("empty"), true));
  EXPECT_FALSE(pid.initParam(ns("does_not_exist")));
}

TEST(PidParameters, RefusesWrongTypesAndKeepsItsGains) {
  Pid pid(1.0, 2.0, 3.0, 4.0, -5.0);
  EXPECT_FALSE(pid.initParam(ns("mistyped_p")));
  EXPECT_FALSE(pid.initParam(ns("mistyped_i")));
  EXPECT_FALSE(pid.initParam(ns("mistyped_antiwindup")));
  expectGains(pid, {1.0, 2.0, 3.0, 4.0, -5.0}, false);
}

TEST(PidParameters, InitResetsTheState) {
  Pid pid(1.0, 1.0, 0.0, 9.0, -9.0);
  pid.computeCommand(3.0, ros::Duration(1.0));
  ASSERT_TRUE(pid.initParam(ns("full")));
  double p, i, d;
  pid.getCurrentPIDErrors(&p, &i, &d);
  EXPECT_EQ(0.0, i);
}

TEST(PidParameters, ReconfigureStartsWithTheGainsInUseAndChangesThem) {
  Pid pid;
  ASSERT_TRUE(pid.initParam(ns("full")));
  const dynamic_reconfigure::Config start = reconfigure(ns("full"), "", 0.0);
  EXPECT_EQ(3.0, numberIn(start, "p"));
  EXPECT_EQ(5.0, numberIn(start, "i_clamp_max"));
  EXPECT_EQ(-5.0, numberIn(start, "i_clamp_min"));
  reconfigure(ns("full"), "d", 12.5);
  expectGains(pid, {3.0, 2.0, 12.5, 5.0, -5.0}, true);
}

TEST(PidParameters, ReconfigureShowsGainsSetByTheProgramOnly) {
  Pid pid;
  ASSERT_TRUE(pid.initParam(ns("wide")));
  pid.setGains(30.0, 20.0, 10.0, 5.0, -6.0, true);
  EXPECT_EQ(30.0, numberIn(reconfigure(ns("wide"), "", 0.0), "p"));
  expectGains(pid, {30.0, 20.0, 10.0, 5.0, -6.0}, true);
}

TEST(PidParameters, CanBeInitializedTwiceAndDestroyedWhileOffered) {
  {
    Pid pid;
    ASSERT_TRUE(pid.initParam(ns("full")));
    ASSERT_TRUE(pid.initParam(ns("full")));
    EXPECT_TRUE(ros::service::exists(ns("full") + "/set_parameters", false));
  }
  EXPECT_FALSE(ros::service::exists(ns("full") + "/set_parameters", false));
}

TEST(PidParameters, InitPidWithANodeOffersReconfigureUnderPid) {
  Pid pid;
  pid.initPid(1.0, 2.0, 3.0, 4.0, -5.0, true, ros::NodeHandle("~"));
  expectGains(pid, {1.0, 2.0, 3.0, 4.0, -5.0}, true);
  EXPECT_EQ(2.0, numberIn(reconfigure("pid", "", 0.0), "i"));
}

TEST(PidParameters, ReadsXml) {
  TiXmlDocument document;
  document.Parse("<pid p='1.5' i='2.5' d='3.5' iClamp='-4.5' antiwindup='true'/>");
  Pid pid;
  ASSERT_TRUE(pid.initXml(document.RootElement()));
  expectGains(pid, {1.5, 2.5, 3.5, 4.5, -4.5}, true);
  document.Clear();
  document.Parse("<pid p='9'/>");
  ASSERT_TRUE(pid.initXml(document.RootElement()));
  expectGains(pid, {9.0, 0.0, 0.0, 0.0, 0.0}, false);
  EXPECT_FALSE(pid.initXml(nullptr));
}

TEST(PidParameters, PublishesItsStateIfConfigured) {
  Pid pid;
  ASSERT_TRUE(pid.initParam(ns("published")));
  std::mutex mutex;
  std::vector<control_msgs::PidState> states;
  ros::NodeHandle node;
  const ros::Subscriber subscriber = node.subscribe<control_msgs::PidState>(
      ns("published") + "/state", 10, [&](const control_msgs::PidStateConstPtr& state) {
        std::lock_guard<std::mutex> lock(mutex);
        states.push_back(*state);
      });
  ASSERT_TRUE(eventually([&] { return subscriber.getNumPublishers() == 1; }));
  pid.computeCommand(3.0, -4.0, ros::Duration(0.5));
  ASSERT_TRUE(eventually([&] {
    std::lock_guard<std::mutex> lock(mutex);
    return !states.empty();
  }));
  const control_msgs::PidState& state = states.front();
  EXPECT_EQ(0.5, state.timestep.toSec());
  EXPECT_EQ(3.0, state.error);
  EXPECT_EQ(-4.0, state.error_dot);
  EXPECT_EQ(3.0, state.p_error);
  EXPECT_EQ(1.5, state.i_error);
  EXPECT_EQ(-4.0, state.d_error);
  EXPECT_EQ(6.0, state.p_term);
  EXPECT_EQ(1.5, state.i_term);
  EXPECT_EQ(-2.0, state.d_term);
  EXPECT_EQ(10.0, state.i_max);
  EXPECT_EQ(-10.0, state.i_min);
  EXPECT_EQ(5.5, state.output);
  EXPECT_FALSE(state.header.stamp.isZero());
}

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "pid_parameters_test");
  ros::AsyncSpinner spinner(2);
  spinner.start();
  const int result = RUN_ALL_TESTS();
  ros::shutdown();
  return result;
}
