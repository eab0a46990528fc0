// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Distances of the arm's links from each other.
#include "robot/safety/self_collision.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "fci_fixture.h"

namespace franka_sim::test {

namespace {

TEST(SelfCollisionGeometry, SegmentDistanceIsTheMinimumOverAllPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<> coordinate(-1, 1);
  for (int sample = 0; sample < 300; sample++) {
    std::array<std::array<double, 3>, 4> p;
    for (auto& point : p) {
      point = {{coordinate(random), coordinate(random), coordinate(random)}};
    }
    if (sample % 10 == 0) {
      p[1] = p[0];  // a point
    }
    if (sample % 15 == 0) {
      for (std::size_t k = 0; k < 3; k++) {
        p[3][k] = p[2][k] + 0.7 * (p[1][k] - p[0][k]);  // parallel
      }
    }
    double smallest = 1e9;
    for (int i = 0; i <= 200; i++) {
      for (int j = 0; j <= 200; j++) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 3; k++) {
          const double d =
              p[0][k] + (p[1][k] - p[0][k]) * i / 200.0 - p[2][k] - (p[3][k] - p[2][k]) * j / 200.0;
          sum += d * d;
        }
        smallest = std::min(smallest, std::sqrt(sum));
      }
    }
    const double distance = segmentDistance(p[0], p[1], p[2], p[3]);
    EXPECT_LE(distance, smallest + 1e-12);
    EXPECT_GE(distance, smallest - 0.02);
  }
}

TEST(SelfCollisionGeometry, KnownPosesAreClassified) {
  SelfCollision collision(true);
  const franka_core::ArmModel model = pandaModel();
  EXPECT_GT(collision.closest(model, kReady).distance, 0.01);
  EXPECT_GT(collision.closest(model, {{0, 0, 0, -1.57, 0, 1.57, 0.785}}).distance, 0.01);
  // The hand folded back into the upper arm.
  EXPECT_LT(collision.closest(model, {{0, 1.7, 0, -3.05, 0, 0.0, 0}}).distance, 0.0);
}

TEST(SelfCollisionGeometry, OverlapsMayShrinkButNotGrow) {
  const franka_core::ArmModel model = pandaModel();
  std::mt19937 random(5);
  SelfCollision collision(true);
  std::array<double, 7> q{};
  for (int found = 0; found < 20;) {
    for (std::size_t i = 0; i < 7; i++) {
      q[i] = std::uniform_real_distribution<>(franka_core::kFerLimits.q_min[i],
                                              franka_core::kFerLimits.q_max[i])(random);
    }
    const double before = collision.closest(model, q).distance;
    if (before > -0.002 || before < -0.004) {
      continue;
    }
    found++;
    for (std::size_t joint = 0; joint < 7; joint++) {
      std::array<double, 7> moved = q;
      moved[joint] += 0.02;
      const double after = collision.closest(model, moved).distance;
      collision.begin(model, q);
      EXPECT_FALSE(collision.violated(model, q));
      if (after < before - 2e-4) {
        EXPECT_TRUE(collision.violated(model, moved));
        EXPECT_LT(collision.overlappingPair().distance, 0.0);
      } else if (after > 0.0) {
        EXPECT_FALSE(collision.violated(model, moved));
        EXPECT_TRUE(collision.violated(model, q)) << "an overlap that ended must not return";
      }
    }
  }
}

TEST(SelfCollisionGeometry, AnOverlapIsFoundInTheTickInWhichItBegins) {
  const franka_core::ArmModel model = pandaModel();
  std::mt19937 random(7);
  std::uniform_real_distribution<> velocity(-2.0, 2.0);
  SelfCollision collision(true), reference(true);
  int found = 0;
  for (int walk = 0; walk < 100; walk++) {
    std::array<double, 7> q = kReady;
    std::array<double, 7> dq;
    for (double& value : dq) {
      value = velocity(random);
    }
    collision.begin(model, q);
    for (int tick = 0; tick < 3000 && found < 1000; tick++) {
      for (std::size_t i = 0; i < 7; i++) {
        const bool within =
            q[i] >= franka_core::kFerLimits.q_min[i] && q[i] <= franka_core::kFerLimits.q_max[i];
        dq[i] = within ? dq[i] : -dq[i];
        q[i] += 1e-3 * dq[i];
      }
      const bool overlaps = reference.closest(model, q).distance < 0.0;
      ASSERT_EQ(overlaps, collision.violated(model, q)) << walk << ", tick " << tick;
      if (overlaps) {
        found++;
        break;
      }
    }
  }
  EXPECT_GT(found, 30);
}

}  // namespace

}  // namespace franka_sim::test
