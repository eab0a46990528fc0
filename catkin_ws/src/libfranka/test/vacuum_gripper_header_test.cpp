// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Programs may name the vendor's class Network after this header alone.
#include <franka/vacuum_gripper.h>
// The header under test comes first and alone.
#include <gtest/gtest.h>

#include <type_traits>

namespace {

class UserOfVacuumGripper {
 public:
  const franka::Network* network{nullptr};
};

TEST(VacuumGripperHeader, DeclaresTheClassNetwork) {
  static_assert(std::is_pointer_v<franka::Network*>);
  EXPECT_EQ(nullptr, UserOfVacuumGripper().network);
}

}  // namespace
