// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <ros/time.h>

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  ros::Time::init();
  return RUN_ALL_TESTS();
}
