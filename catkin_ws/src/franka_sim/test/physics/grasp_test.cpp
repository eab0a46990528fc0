// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// A stone between two fingers, held only by friction.
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_contacts.h>

#include <cmath>

#include "stone_in_hand.h"

namespace franka_sim::test {
namespace {

class GraspTest : public StoneInHandTest {
 protected:
  static constexpr double kFingerForce = 2.5;  ///< half of the hand's 5 N
  static constexpr double kWeight = 0.1024 * 9.81;

  Eigen::Vector3d forceFrom(const std::string& finger) {
    return forceOn("stone", id() + "_" + finger);
  }
};

TEST_P(GraspTest, PadsPressWithTheFingerForceAndCarryTheWeight) {
  placeStone();
  run(2000, kFingerForce);
  const Eigen::Vector3d left = forceFrom("leftfinger");
  const Eigen::Vector3d right = forceFrom("rightfinger");
  const Eigen::Vector3d across =
      toEigen(bodyPose(world_, id() + "_hand")).linear() * Eigen::Vector3d::UnitY();
  // Left finger opens along +y of the hand, so it pushes the stone along -y.
  EXPECT_NEAR(-kFingerForce, left.dot(across), 0.1 * kFingerForce);
  EXPECT_NEAR(kFingerForce, right.dot(across), 0.1 * kFingerForce);
  EXPECT_NEAR(kWeight, left.z() + right.z(), 1e-2 * kWeight);
  EXPECT_NEAR(0.032, hand_->measure().q[0] + hand_->measure().q[1], 5e-4);
}

TEST_P(GraspTest, WhatTouchesTheStoneIsShownInBrief) {
  const auto partners = [this] {
    const Touches found = touches(world_, "stone");
    return std::make_pair(found.robots, found.others);
  };
  run(1000, -kFingerForce);
  EXPECT_EQ(std::make_pair(std::vector<std::string>{}, true), partners()) << "on its tray";
  placeStone();
  EXPECT_TRUE(partners().second) << "in the last step";
  run(1000, kFingerForce);
  EXPECT_EQ(std::make_pair(std::vector<std::string>{id()}, false), partners()) << "in the hand";
  EXPECT_THROW(touches(world_, "pebble"), std::runtime_error);
}

TEST_P(GraspTest, StoneStaysGraspedForAMinuteOfMotion) {
  placeStone();
  run(1000, kFingerForce);
  const Eigen::Vector3d start = stoneInHand();
  Eigen::Vector3d last_tcp = toEigen(bodyPose(world_, id() + "_hand_tcp")).translation();
  double fastest = 0, farthest = 0;
  for (int k = 0; k < 60000; ++k) {
    const double t = 0.001 * k;
    const double ramp = std::min(1.0, t / 2);
    auto q_d = kHome;
    std::array<double, 7> dq_d{};
    const auto swing = [&](int joint, double amplitude, double omega) {
      q_d[joint] += ramp * amplitude * std::sin(omega * t);
      dq_d[joint] = ramp * amplitude * omega * std::cos(omega * t);
    };
    swing(0, 0.4, 1.5);
    swing(3, 0.15, 2.1);
    swing(5, 0.25, 1.7);
    swing(6, 0.4, 1.1);
    tick(kFingerForce, q_d, dq_d);
    if (k % 10 == 9) {
      const Eigen::Vector3d tcp = toEigen(bodyPose(world_, id() + "_hand_tcp")).translation();
      fastest = std::max(fastest, (tcp - last_tcp).norm() / 0.01);
      last_tcp = tcp;
      farthest = std::max(farthest, (stoneInHand() - start).norm());
    }
  }
  EXPECT_GT(fastest, 0.25) << "the motion was too slow to show anything";
  EXPECT_LT(farthest, 2e-3);
  EXPECT_GT(forceFrom("leftfinger").norm(), 0.5 * kFingerForce);
  EXPECT_GT(forceFrom("rightfinger").norm(), 0.5 * kFingerForce);
}

/// Two pads with friction 0.6 carry at most 2 * 0.6 * F: below 0.84 N the stone must slip.
TEST_P(GraspTest, StoneSlipsWithTooLittleForce) {
  placeStone();
  run(1500, 0.6);
  EXPECT_GT(stoneInHand().z(), 0.1034 + 0.02) << "friction of the stone (0.6) decides, not 1.13";
}

/// With so many contacts between cubes, conjugate gradients solve all constraints, those of the
/// grasp included.
TEST_P(GraspTest, GraspHoldsBesideAPile) {
  placeStone();
  int cubes = 0;
  for (int layer = 0; layer < 4; ++layer) {
    const int side = 4 - layer;
    for (int i = 0; i < side * side; ++i) {
      const int row = i / side;
      const double x = 2 + 0.041 * (i % side + 0.5 * layer);
      const double y = 0.041 * (row + 0.5 * layer);
      const Pose pose{{x, y, 0.02 + 0.041 * layer}};
      world_.addObject(
          "cube" + std::to_string(cubes++),
          "<body><freejoint/><geom type='box' size='0.02 0.02 0.02' mass='0.05' solref='0.01 1'/>"
          "</body>",
          pose);
    }
  }
  run(500, kFingerForce);
  EXPECT_GT(contacts(world_).size(), 250u);
  EXPECT_TRUE(world_.takeWarnings().empty());
  const Eigen::Vector3d left = forceFrom("leftfinger");
  const Eigen::Vector3d right = forceFrom("rightfinger");
  EXPECT_NEAR(kWeight, left.z() + right.z(), 1e-2 * kWeight);
  const auto fingers = hand_->measure().q;
  EXPECT_NEAR(fingers[0], fingers[1], 1e-5);
  const Eigen::Vector3d start = stoneInHand();
  run(500, kFingerForce);
  EXPECT_LT((stoneInHand() - start).norm(), 1e-4);
  for (int i = 0; i < cubes; ++i) {
    const double layer = i < 16 ? 0 : i < 25 ? 1 : i < 29 ? 2 : 3;
    EXPECT_NEAR(0.02 + 0.04 * layer, bodyPose(world_, "cube" + std::to_string(i)).position[2], 1e-3)
        << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, GraspTest, ::testing::Values("panda", "fr3"));

}  // namespace
}  // namespace franka_sim::test
