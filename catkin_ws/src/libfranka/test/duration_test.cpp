// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/duration.h>
#include <gtest/gtest.h>

#include <chrono>

namespace {

using franka::Duration;

TEST(Duration, ConvertsBothWays) {
  EXPECT_EQ(0u, Duration().toMSec());
  EXPECT_EQ(1234u, Duration(1234).toMSec());
  EXPECT_DOUBLE_EQ(1.234, Duration(1234).toSec());
  const std::chrono::duration<uint64_t, std::milli> chrono = Duration(17);
  EXPECT_EQ(17u, chrono.count());
  EXPECT_EQ(Duration(17), Duration(chrono));
}

TEST(Duration, SupportsArithmetic) {
  const Duration seven(7), three(3);
  EXPECT_EQ(Duration(10), seven + three);
  EXPECT_EQ(Duration(4), seven - three);
  EXPECT_EQ(Duration(21), seven * 3);
  EXPECT_EQ(Duration(21), 3 * seven);
  EXPECT_EQ(2u, seven / three);
  EXPECT_EQ(Duration(2), seven / 3);
  EXPECT_EQ(Duration(1), seven % three);
  EXPECT_EQ(Duration(1), seven % 3);
}

TEST(Duration, SupportsArithmeticInPlace) {
  Duration d(7);
  EXPECT_EQ(Duration(10), d += Duration(3));
  EXPECT_EQ(Duration(8), d -= Duration(2));
  EXPECT_EQ(Duration(24), d *= 3);
  EXPECT_EQ(Duration(6), d /= 4);
  EXPECT_EQ(Duration(2), d %= Duration(4));
  EXPECT_EQ(Duration(0), d %= 2);
  EXPECT_EQ(Duration(0), d);
}

TEST(Duration, Compares) {
  const Duration one(1), two(2);
  EXPECT_TRUE(one == Duration(1) && one != two);
  EXPECT_TRUE(one < two && one <= two && one <= Duration(1));
  EXPECT_TRUE(two > one && two >= one && two >= Duration(2));
  EXPECT_FALSE(one > two || two < one || one == two);
}

}  // namespace
