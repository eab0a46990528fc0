// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Programs may name the vendor's class Network after this header alone.
#include <franka/gripper.h>
// The header under test comes first and alone.
#include <gtest/gtest.h>

#include <type_traits>

namespace {

class UserOfGripper {
 public:
  const franka::Network* network{nullptr};
};

TEST(GripperHeader, DeclaresTheClassNetwork) {
  static_assert(std::is_pointer_v<franka::Network*>);
  EXPECT_EQ(nullptr, UserOfGripper().network);
}

}  // namespace
