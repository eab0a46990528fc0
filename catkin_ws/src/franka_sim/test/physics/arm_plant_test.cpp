// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world_pushes.h>

#include <cmath>

#include "test_support.h"

namespace franka_sim::test {
namespace {

class ArmPlantTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::string id() const { return GetParam(); }
  void put(RobotDescription description) {
    world_.addRobot(description);
    arm_ = &world_.arm(description.name, id());
    holder_ = std::make_unique<ArmHolder>(arm_, id());
  }

  /// Holds the pose, except for joint 1, which has this torque [Nm].
  template <typename Torque>
  void turnJoint1(int ticks, Torque torque) {
    for (int k = 0; k < ticks; ++k) {
      auto tau = holder_->torques(kHome);
      tau[0] = torque();
      arm_->applyTorques(tau);
      world_.step();
    }
  }

  World world_;
  ArmPlant* arm_{nullptr};
  std::unique_ptr<ArmHolder> holder_;
};

TEST_P(ArmPlantTest, StartsAtTheInitialPositions) {
  put(robot(id()));
  const ArmMeasurement m = arm_->measure();
  for (int i = 0; i < 7; ++i) {
    EXPECT_EQ(kHome[i], m.q[i]);
    EXPECT_EQ(0.0, m.dq[i]);
    EXPECT_EQ(0.0, m.tau_J[i]);
  }
}

/// In motion tau_J = M_link a + c + g at a point between the ticks (decision 3), without the
/// rotors' share. Independent reference: ArmModel.
TEST_P(ArmPlantTest, TorqueInMotionExcludesTheRotors) {
  put(robot(id()));
  double worst = 0, rotor = 0;
  ArmMeasurement last = arm_->measure();
  for (int k = 0; k < 4000; ++k) {
    auto tau = holder_->model().gravity(last.q, holder_->payload());
    for (int i = 0; i < 7; ++i) {
      tau[i] += 6.0 * std::sin(2 * M_PI * (0.5 + 0.1 * i) * world_.time()) - 3.0 * last.dq[i] -
                20 * (last.q[i] - kHome[i]);
    }
    arm_->applyTorques(tau);
    world_.step();
    const ArmMeasurement now = arm_->measure();
    // Two physics steps: a quarter of the way.
    const double share = now.substeps == 1 ? 0.0 : 0.25;
    std::array<double, 7> q, dq, a;
    for (int i = 0; i < 7; ++i) {
      q[i] = last.q[i] + share * (now.q[i] - last.q[i]);
      dq[i] = last.dq[i] + share * (now.dq[i] - last.dq[i]);
      a[i] = (now.dq[i] - last.dq[i]) / World::kTick;
      EXPECT_NEAR(tau[i] - kRotorInertia * a[i], now.tau_J[i], 1e-10);
      rotor = std::max(rotor, std::abs(kRotorInertia * a[i]));
    }
    const auto expected = holder_->model().inverseDynamics(q, dq, a, holder_->payload());
    for (int i = 0; i < 7; ++i) {
      worst = std::max(worst, std::abs(expected[i] - now.tau_J[i]));
    }
    last = now;
  }
  EXPECT_LT(worst, 5e-3);
  EXPECT_GT(rotor, 0.3) << "the motion was too slow to show anything";
}

/// The law of JointFriction in closed form [Nm].
double linkFriction(const JointFriction& law, double dq) {
  return law.amplitude / (1.0 + std::exp(-law.slope * (dq + law.offset))) -
         law.amplitude / (1.0 + std::exp(-law.slope * law.offset)) + law.viscous * dq;
}

TEST_P(ArmPlantTest, SensorMeasuresTheLinkSidesFrictionOnly) {
  RobotDescription description = robot(id());
  const JointFriction law{1.2, 8.0, 0.03, 0.4, 1.5};
  description.friction[id() + "_joint1"] = law;
  put(description);
  for (const double speed : {0.5, -0.3}) {
    // Constant speed of joint 1 by a stiff speed loop; it turns about the vertical: no gravity.
    double motor = 0.0;
    turnJoint1(1500, [&] { return motor = 30.0 * (speed - arm_->measure().dq[0]); });
    const ArmMeasurement m = arm_->measure();
    const double link = linkFriction(law, m.dq[0]);
    EXPECT_NEAR(link, m.tau_J[0], 5e-3);
    EXPECT_NEAR(link + std::copysign(1.5, speed), motor, 5e-3);
  }
}

/// Torque below the motor side's Coulomb friction does not move the arm, and the sensor does not
/// show it.
TEST_P(ArmPlantTest, DryFrictionHoldsTheJointWithoutCreepAndIsNotMeasured) {
  RobotDescription description = robot(id());
  description.friction[id() + "_joint1"].coulomb = 1.5;
  put(description);
  // A step would make the arm swing beyond.
  const auto torque = [this] { return std::min(1.4, world_.time()); };
  turnJoint1(3000, torque);
  const double rests_at = arm_->measure().q[0];
  EXPECT_NEAR(0.0, arm_->measure().tau_J[0], 1e-6);
  EXPECT_NEAR(kHome[0] + 1e-4 * 1.4 / 1.5, rests_at, 1e-6) << "the spring of the motor side";
  turnJoint1(10000, torque);
  EXPECT_NEAR(rests_at, arm_->measure().q[0], 1e-9) << "it creeps";
}

/// The same future after a snapshot, a reset and another robot's arrival.
TEST_P(ArmPlantTest, FrictionIsPartOfTheWorldsState) {
  RobotDescription description = robot(id());
  description.friction[id() + "_joint1"].coulomb = 1.5;
  put(description);
  const auto run = [this](int ticks) {
    turnJoint1(ticks, [] { return 1.4; });
    return world_.stateHash();
  };
  const std::uint64_t first = run(20);
  const Snapshot snapshot = world_.snapshot();
  const std::uint64_t second = run(20);
  world_.restore(snapshot);
  EXPECT_EQ(first, world_.stateHash());
  EXPECT_EQ(second, run(20));
  world_.reset();
  EXPECT_EQ(first, run(20));
  run(1000);
  const double held = arm_->measure().q[0];
  world_.addObject("stone", "<body><freejoint/><geom type='box' size='.02 .02 .02'/></body>",
                   {{2, 0, 0.02}});
  run(200);
  EXPECT_NEAR(held, arm_->measure().q[0], 1e-6) << "the friction let go";
}

TEST_P(ArmPlantTest, ClosedBrakesHoldForTenSecondsWithoutTorque) {
  put(robot(id()));
  for (int k = 0; k < 200; ++k) {
    holder_->hold(kHome);
    world_.step();
  }
  arm_->setBrakes(true);
  arm_->applyTorques({50, 50, 50, 50, 10, 10, 10});  // ignored
  run(world_, 100);
  const ArmMeasurement before = arm_->measure();
  run(world_, 10000);
  const ArmMeasurement after = arm_->measure();
  const auto gravity = holder_->model().gravity(after.q, holder_->payload());
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(before.q[i], after.q[i], 1e-9);
    EXPECT_NEAR(kHome[i], after.q[i], 2e-5);
    EXPECT_NEAR(gravity[i], after.tau_J[i], 1e-3) << "the sensor shows the brake's torque";
  }
}

TEST_P(ArmPlantTest, BrakesHoldAgainstAPushAndOpenAgain) {
  put(robot(id()));
  arm_->setBrakes(true);
  pushBody(world_, id() + "_hand", {60, 40, -50}, {}, 2000);
  run(world_, 2000);
  test::expectNear(kHome, arm_->measure().q, 2e-5);
  arm_->setBrakes(false);
  arm_->applyTorques({});
  run(world_, 300);
  EXPECT_GT(std::abs(arm_->measure().q[1] - kHome[1]), 1e-2) << "it must fall";
}

TEST_P(ArmPlantTest, BrakesStopAMovingArm) {
  put(robot(id()));
  turnJoint1(500, [this] { return 30.0 * (1.0 - arm_->measure().dq[0]); });
  ASSERT_GT(arm_->measure().dq[0], 0.9);
  const double q = arm_->measure().q[0];
  arm_->setBrakes(true);
  run(world_, 100);
  EXPECT_NEAR(0.0, arm_->measure().dq[0], 1e-6);
  EXPECT_NEAR(q, arm_->measure().q[0], 1e-4);
}

TEST_P(ArmPlantTest, NonFiniteTorquesCountAsZero) {
  put(robot(id()));
  arm_->applyTorques({NAN, INFINITY, 0, 0, 0, 0, 0});
  world_.step();
  EXPECT_NEAR(kHome[0], arm_->measure().q[0], 1e-3);
  EXPECT_EQ(1u, world_.ticks());
}

TEST_P(ArmPlantTest, JointStopsLimitTheTravel) {
  RobotDescription description = robot(id());
  description.stops[id() + "_joint1"] = {-0.3, 0.5};
  put(description);
  turnJoint1(4000, [] { return 20.0; });
  EXPECT_NEAR(0.5, arm_->measure().q[0], 0.01);
}

TEST_P(ArmPlantTest, FingersMoveTogetherBetweenTheirStops) {
  put(robot(id()));
  ASSERT_TRUE(world_.hasHand(id(), id()));
  HandPlant& hand = world_.hand(id(), id());
  const auto run = [&](std::array<double, 2> force, int ticks) {
    for (int k = 0; k < ticks; ++k) {
      holder_->hold(kHome);
      hand.applyForces(force);
      world_.step();
      const HandMeasurement m = hand.measure();
      ASSERT_NEAR(m.q[0], m.q[1], 2e-4);
    }
  };
  run({3, 0}, 1500);  // one finger's force opens both
  EXPECT_NEAR(0.04, hand.measure().q[0], 5e-4);
  EXPECT_NEAR(0.04, hand.measure().q[1], 5e-4);
  run({0, -3}, 1500);
  EXPECT_NEAR(0.0, hand.measure().q[0], 5e-4);
  EXPECT_NEAR(0.0, hand.measure().q[1], 5e-4);
}

TEST_P(ArmPlantTest, NamesMissingJoints) {
  put(robot(id()));
  expectSentence([&] { world_.arm(id(), "left"); }, {"'left_joint1'", id().c_str()});
  expectSentence([&] { world_.hand(id(), "left"); }, {"'left_finger_joint1'"});
  expectSentence([&] { world_.arm("nobody", id()); }, {"no robot 'nobody'"});
  EXPECT_FALSE(world_.hasHand(id(), "left"));
}

INSTANTIATE_TEST_SUITE_P(Robots, ArmPlantTest, ::testing::Values("panda", "fr3"));

}  // namespace
}  // namespace franka_sim::test
