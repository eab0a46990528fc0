// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Packages use ROS after the original's header alone.
#include <transmission_interface/transmission_parser.h>
// The header under test comes first and alone.
#include <gtest/gtest.h>

namespace {

TEST(TransmissionParserHeader, BringsRos) {
  const ros::NodeHandle* const node = nullptr;
  EXPECT_EQ(nullptr, node);
  ros::Time::init();
  ROS_DEBUG("Logging needs no other header.");
  EXPECT_FALSE(ros::Time::now().isZero());
}

}  // namespace
