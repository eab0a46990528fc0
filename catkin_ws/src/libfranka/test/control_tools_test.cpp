// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/control_tools.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <limits>

#include "franka/realtime_setup.h"

namespace {

const std::array<double, 16> kPose{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.3, 0.4, 0.5, 1};

TEST(ControlTools, ElbowSignMustBeExactlyOne) {
  EXPECT_TRUE(franka::isValidElbow({0.0, 1.0}));
  EXPECT_TRUE(franka::isValidElbow({0.0, -1.0}));
  for (double sign : {0.0, 0.999, -1.0000001, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(franka::isValidElbow({0.0, sign}));
  }
}

TEST(ControlTools, RecognizesHomogeneousTransformations) {
  EXPECT_TRUE(franka::isHomogeneousTransformation(kPose));
  EXPECT_FALSE(franka::isHomogeneousTransformation({}));
  for (std::size_t i : {3, 7, 11, 15}) {
    std::array<double, 16> wrong = kPose;
    wrong[i] += 1e-12;
    EXPECT_FALSE(franka::isHomogeneousTransformation(wrong)) << i;
  }
  for (std::size_t i : {0, 1, 2, 4, 5, 6, 8, 9, 10}) {
    std::array<double, 16> wrong = kPose;
    wrong[i] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(franka::isHomogeneousTransformation(wrong)) << i;
  }
}

TEST(ControlTools, ToleratesRoundingOfUnitLength) {
  std::array<double, 16> pose = kPose;
  pose[1] = 1.0 + 9e-6;
  EXPECT_TRUE(franka::isHomogeneousTransformation(pose));
  pose[1] = 1.0 + 1.1e-5;
  EXPECT_FALSE(franka::isHomogeneousTransformation(pose));
  pose[1] = 1.0 - 1.1e-5;
  EXPECT_FALSE(franka::isHomogeneousTransformation(pose));
}

TEST(ControlTools, ReportsWhyMemoryIsNotLocked) {
  const std::string warning = franka::lockMemory([](int) {
    errno = ENOMEM;
    return -1;
  });
  EXPECT_NE(std::string::npos, warning.find("memlock")) << warning;
  EXPECT_NE(std::string::npos, warning.find("Cannot allocate memory")) << warning;
  EXPECT_EQ("", franka::lockMemory([](int) { return 0; }));
}

// Gives its thread real-time priority where that is allowed.
TEST(ControlToolsOnWallClock, ReportsWhyRealtimePriorityFailed) {
  std::string message;
  if (!franka::setCurrentThreadToHighestSchedulerPriority(&message)) {
    EXPECT_NE(std::string::npos, message.find("rtprio")) << message;
  } else {
    EXPECT_TRUE(message.empty());
  }
}

}  // namespace
