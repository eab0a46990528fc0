// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka/model.h>
#include <gtest/gtest.h>

namespace {

TEST(Exception, VersionMismatchNamesTheRobotAndGivesAdvice) {
  const std::string panda = franka::IncompatibleVersionException(5, 10).what();
  EXPECT_NE(std::string::npos, panda.find("(server version: 5, library version: 10)")) << panda;
  EXPECT_NE(std::string::npos, panda.find("a Panda with system 4.2.1")) << panda;
  const std::string newer = franka::IncompatibleVersionException(12, 10).what();
  EXPECT_NE(std::string::npos, newer.find("update this library")) << newer;
  const std::string older = franka::IncompatibleVersionException(1, 10).what();
  EXPECT_NE(std::string::npos, older.find("at least to 1.3 or later on a Panda")) << older;
  // A gripper has other version numbers.
  const std::string gripper = franka::IncompatibleVersionException(5, 3).what();
  EXPECT_EQ(std::string::npos, gripper.find("Panda")) << gripper;
}

TEST(Frame, LoopsOverTheTen) {
  int count = 0;
  franka::Frame frame = franka::Frame::kJoint1;
  EXPECT_EQ(franka::Frame::kJoint1, frame++);
  EXPECT_EQ(franka::Frame::kJoint2, frame);
  for (franka::Frame f = franka::Frame::kJoint1; f <= franka::Frame::kStiffness; f++) {
    count++;
  }
  EXPECT_EQ(10, count);
}

}  // namespace
