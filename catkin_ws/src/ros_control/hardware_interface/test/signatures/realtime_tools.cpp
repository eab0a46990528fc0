// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <actionlib/TestAction.h>
#include <realtime_tools/realtime_box.h>
#include <realtime_tools/realtime_buffer.h>
#include <realtime_tools/realtime_clock.h>
#include <realtime_tools/realtime_publisher.h>
#include <realtime_tools/realtime_server_goal_handle.h>
#include <std_msgs/String.h>

#include <memory>
#include <mutex>
#include <string>

#include "signature.h"

using namespace realtime_tools;

typedef RealtimePublisher<std_msgs::String> Publisher;
static_assert(!std::is_copy_constructible<Publisher>::value, "");
static_assert(std::is_default_constructible<Publisher>::value, "");
static_assert(std::is_constructible<Publisher, const ros::NodeHandle&, std::string, int>::value,
              "");
static_assert(
    std::is_constructible<Publisher, const ros::NodeHandle&, std::string, int, bool>::value, "");
EXPECT_TYPE(std_msgs::String&, (of<Publisher>().msg_));
EXPECT_TYPE(void, of<Publisher>().init(of<const ros::NodeHandle>(), std::string(), 1));
EXPECT_TYPE(void, of<Publisher>().init(of<const ros::NodeHandle>(), std::string(), 1, true));
EXPECT_TYPE(void, of<Publisher>().stop());
EXPECT_TYPE(bool, of<Publisher>().trylock());
EXPECT_TYPE(void, of<Publisher>().unlockAndPublish());
EXPECT_TYPE(void, of<Publisher>().lock());
EXPECT_TYPE(void, of<Publisher>().unlock());
EXPECT_TYPE(std::lock_guard<Publisher>, std::lock_guard<Publisher>(of<Publisher>()));
EXPECT_TYPE(RealtimePublisherSharedPtr<std_msgs::String>, std::shared_ptr<Publisher>());

typedef RealtimeBuffer<std::string> Buffer;
static_assert(std::is_default_constructible<Buffer>::value, "");
static_assert(std::is_copy_constructible<Buffer>::value, "");
static_assert(std::is_copy_assignable<Buffer>::value, "");
EXPECT_TYPE(std::string*, Buffer(std::string()).readFromRT());
EXPECT_TYPE(std::string*, of<const Buffer>().readFromNonRT());
EXPECT_TYPE(void, of<Buffer>().writeFromNonRT(std::string()));
EXPECT_TYPE(void, of<Buffer>().initRT(std::string()));

typedef RealtimeBox<std::string> Box;
static_assert(std::is_default_constructible<Box>::value, "");
EXPECT_TYPE(void, Box(std::string()).set(std::string()));
EXPECT_TYPE(void, of<Box>().get(of<std::string>()));

EXPECT_TYPE(ros::Time, RealtimeClock().getSystemTime(of<const ros::Time>()));
EXPECT_TYPE(void, of<RealtimeClock>().loop());

typedef RealtimeServerGoalHandle<actionlib::TestAction> Goal;
typedef actionlib::ServerGoalHandle<actionlib::TestAction> Handle;
static_assert(std::is_constructible<Goal, Handle&>::value, "");
static_assert(std::is_constructible<Goal, Handle&, const boost::shared_ptr<actionlib::TestResult>&,
                                    const boost::shared_ptr<actionlib::TestFeedback>&>::value,
              "");
EXPECT_TYPE(Handle&, (of<Goal>().gh_));
EXPECT_TYPE(boost::shared_ptr<actionlib::TestResult>&, (of<Goal>().preallocated_result_));
EXPECT_TYPE(boost::shared_ptr<actionlib::TestFeedback>&, (of<Goal>().preallocated_feedback_));
EXPECT_TYPE(void, of<Goal>().setAborted());
EXPECT_TYPE(void, of<Goal>().setCanceled());
EXPECT_TYPE(void, of<Goal>().setSucceeded());
EXPECT_TYPE(void, of<Goal>().setSucceeded(of<Goal>().preallocated_result_));
EXPECT_TYPE(void, of<Goal>().setFeedback(of<Goal>().preallocated_feedback_));
EXPECT_TYPE(bool, of<Goal>().valid());
EXPECT_TYPE(void, of<Goal>().runNonRealtime(ros::TimerEvent()));
