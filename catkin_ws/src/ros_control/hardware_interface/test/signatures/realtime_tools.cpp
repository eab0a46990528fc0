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
#include <string>

#include "signature.h"

using namespace realtime_tools;

typedef RealtimePublisher<std_msgs::String> Publisher;
static_assert(!std::is_copy_constructible<Publisher>::value, "");
EXPECT_TYPE(void, of<Publisher>().init(of<const ros::NodeHandle>(), std::string(), 1));
EXPECT_TYPE(RealtimePublisherSharedPtr<std_msgs::String>, std::shared_ptr<Publisher>());

typedef RealtimeBuffer<std::string> Buffer;
EXPECT_TYPE(std::string*, of<const Buffer>().readFromNonRT());
static_assert(std::is_default_constructible<RealtimeBox<std::string>>::value, "");

EXPECT_TYPE(ros::Time, RealtimeClock().getSystemTime(of<const ros::Time>()));
EXPECT_TYPE(void, of<RealtimeClock>().loop());

typedef RealtimeServerGoalHandle<actionlib::TestAction> Goal;
EXPECT_TYPE(void, of<Goal>().setAborted());
EXPECT_TYPE(boost::shared_ptr<actionlib::TestResult>&, (of<Goal>().preallocated_result_));
EXPECT_TYPE(boost::shared_ptr<actionlib::TestFeedback>&, (of<Goal>().preallocated_feedback_));
