// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Parts of the motion supervisor: torque steps, virtual walls, answers that come later.
#include <Eigen/Geometry>
#include <random>

#include "fci_fixture.h"
#include "robot/safety/virtual_walls.h"
#include "robot/supervisor/motion_supervisor.h"
#include "robot/supervisor/pending_answers.h"

namespace franka_sim::test {

namespace {

TEST(TorqueCommand, StepsAreJudgedFromTheCommandedAndFromTheSaturatedTorque) {
  struct Row {
    double before, next;  // of joint 1, whose motor gives 87 Nm [Nm]
    bool jumps;
  };
  const Row rows[] = {
      {10.0, 11.0, false}, {10.0, 11.1, true},  // 1 Nm in a tick
      {88.5, 89.4, false},                      // near the commanded torque only
      {88.5, 86.1, false},                      // near the saturated torque only
      {88.5, 90.0, true},  {88.5, 85.9, true}, {-95, -86.5, false}, {-95, -85.9, true},
  };
  for (const Row& row : rows) {
    TorqueCommand command(std::array<double, 7>{{87, 87, 87, 87, 12, 12, 12}});
    ASSERT_TRUE(command.receive({{row.before, 0, 0, 0, 0, 0, 0}}));
    EXPECT_EQ(row.jumps, command.jumps({{row.next, 0, 0, 0, 0, 0, 0}}))
        << row.before << " to " << row.next;
  }
}

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

TEST(PendingAnswers, InterruptionReplacesSuccessOnly) {
  for (const Status own : {Status::kSuccess, Status::kPreempted}) {
    PendingAnswers answers;
    answers.motionEndsAtRest(own);
    answers.interruptMotion(Status::kReflexAborted);
    EXPECT_EQ(own == Status::kSuccess ? Status::kReflexAborted : own,
              answers.take(PendingAnswer::kMotion));
    EXPECT_FALSE(answers.waitForRest());
  }
}

TEST(PendingAnswers, StopIsInterruptedOnlyWhileItWaits) {
  PendingAnswers answers;
  answers.interruptStop(Status::kReflexAborted);
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kStop));
  answers.stopBegins();
  answers.interruptStop(Status::kReflexAborted);
  answers.atRest();
  EXPECT_EQ(Status::kReflexAborted, answers.take(PendingAnswer::kStop));
}

}  // namespace

}  // namespace franka_sim::test
