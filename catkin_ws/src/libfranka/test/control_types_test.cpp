// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/control_types.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace {

template <typename Type>
void expectRefused(std::initializer_list<double> values) {
  EXPECT_THROW(Type{values}, std::invalid_argument);
}

TEST(ControlTypes, RefuseListsOfTheWrongSize) {
  expectRefused<franka::Torques>({});
  expectRefused<franka::Torques>({1, 2, 3, 4, 5, 6});
  expectRefused<franka::JointPositions>({1, 2, 3, 4, 5, 6, 7, 8});
  expectRefused<franka::JointVelocities>({1});
  expectRefused<franka::CartesianPose>({1, 2, 3, 4, 5, 6, 7});
  expectRefused<franka::CartesianVelocities>({1, 2, 3, 4, 5, 6, 7});
  using Pair = std::initializer_list<double>;
  EXPECT_THROW((franka::CartesianVelocities{Pair{1, 2, 3, 4, 5, 6}, Pair{1}}),
               std::invalid_argument);
  EXPECT_THROW(
      (franka::CartesianPose{Pair{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}, Pair{1, 1, 1}}),
      std::invalid_argument);
}

}  // namespace
