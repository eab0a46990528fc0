// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Virtual walls.
#include <Eigen/Geometry>
#include <random>

#include "fci_fixture.h"
#include "robot/motion_supervisor.h"

namespace franka_sim::test {

namespace {

TEST(VirtualWalls, ActAtTheFacesOfARotatedCuboid) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int inside = 0;
  for (int k = 0; k < 2000; k++) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << 0.3 * uniform(random), 0.3 * uniform(random), 0.3 * uniform(random);
    pose.linear() =
        Eigen::AngleAxisd(3.1 * uniform(random),
                          Eigen::Vector3d(uniform(random), uniform(random), 1.0).normalized())
            .toRotationMatrix();
    codec::CartesianLimit wall;
    wall.object_world_size = {{0.3, 0.6, 0.9}};
    Eigen::Map<Eigen::Matrix4d>(wall.object_frame.data()) = pose.matrix();
    wall.active = true;
    VirtualWalls walls;
    ASSERT_TRUE(walls.set(0, wall));
    Transform far = franka_core::kIdentityTransform;
    far[12] = 5.0;
    walls.begin(far);

    Transform hand = franka_core::kIdentityTransform;
    for (const std::size_t i : {12, 13, 14}) {
      hand[i] = 0.6 * uniform(random);
    }
    const Eigen::Vector3d local = pose.inverse() * Eigen::Vector3d(hand[12], hand[13], hand[14]);
    const bool expected =
        local.cwiseAbs().x() < 0.15 && local.cwiseAbs().y() < 0.3 && local.cwiseAbs().z() < 0.45;
    EXPECT_EQ(expected, walls.violated(hand)) << k;
    inside += expected ? 1 : 0;
  }
  EXPECT_GT(inside, 100);
}

}  // namespace

}  // namespace franka_sim::test
