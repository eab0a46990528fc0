// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The external wrench at K, and products of transforms.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "robot/estimator/state_estimator.h"
#include "robot/transforms.h"

namespace franka_sim::test {

namespace {

TEST(ExternalWrench, InvertsTheTransposedJacobianAtK) {
  // A Jacobian of a Cartesian machine whose seventh joint equals the first.
  std::array<double, 42> J{};
  for (std::size_t i = 0; i < 6; i++) {
    J[6 * i + i] = 1.0;
  }
  J[36] = 1.0;
  Transform O_T_EE = {{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}};
  Transform EE_T_K = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}};
  ExternalWrench map;
  map.update(O_T_EE, J, EE_T_K);
  ASSERT_FALSE(map.singular());
  // K lies at r = (0, 1, 0) in O; a force f and a moment m there turn the joints by f, and m + r x
  // f.
  const std::array<double, 6> F{{1, 2, 3, 4, 5, 6}};
  const std::array<double, 7> tau{{1, 2, 3, 4 + 3, 5, 6 - 1, 1}};
  const std::array<double, 6> wrench = map.inBase(tau);
  for (std::size_t i = 0; i < 6; i++) {
    EXPECT_NEAR(F[i], wrench[i], 1e-12) << i;
  }
  const std::array<double, 6> in_K = map.inStiffness(wrench);
  const std::array<double, 6> expected{{2, -1, 3, 5, -4, 6}};
  for (std::size_t i = 0; i < 6; i++) {
    EXPECT_NEAR(expected[i], in_K[i], 1e-12) << i;
  }
}

TEST(Transforms, MultiplyInTheRightOrder) {
  const Transform turn = {{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  Transform shift = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1}};
  const Transform turned = multiply(turn, shift);
  EXPECT_EQ(-2, turned[12]);
  EXPECT_EQ(1, turned[13]);
  EXPECT_EQ(3, turned[14]);
}

}  // namespace

}  // namespace franka_sim::test
