// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Steps that leave out collisions of robots give the same states, bit for bit (decision 56).
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_joints.h>

#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "physics/world/world_impl.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

/// One world that leaves collisions out where it can, and one that never does.
class RobotClearanceTest : public ::testing::TestWithParam<const char*> {
 protected:
  struct Side {
    explicit Side(const std::string& file) : world(file) {}

    World world;
    std::vector<ArmPlant*> arms;
    std::vector<HandPlant*> hands;
    std::vector<ArmHolder> holders;
  };

  explicit RobotClearanceTest(const char* world_file = "stone")
      : quick_(test::world(world_file)), plain_(test::world(world_file)) {
    for (Side* side : {&quick_, &plain_}) {
      side->world.setSubsteps(Substeps::kSmall);
      implOf(side->world).object_rest.use(false);  // it changes the last digits
    }
    implOf(plain_.world).clearance.use(false);
  }

  std::string kind() const { return GetParam(); }

  void add(const std::string& arm_id, double x, double y, double z) {
    for (Side* side : {&quick_, &plain_}) {
      RobotDescription description = robot(kind(), arm_id);
      description.base.position = {x, y, z};
      side->world.addRobot(description);
      side->arms.push_back(&side->world.arm(arm_id, arm_id));
      side->hands.push_back(&side->world.hand(arm_id, arm_id));
      side->holders.emplace_back(side->arms.back(), kind());
    }
  }

  void addBlock(const std::string& name, const Pose& pose) {
    for (Side* side : {&quick_, &plain_}) {
      side->world.addObject(
          name, "<body name='" + name + "'><geom type='box' size='0.05 0.05 0.2'/></body>", pose);
    }
  }

  /// A tick of both worlds with the same inputs; compares the states.
  void tick(const std::vector<std::array<double, 7>>& q_d, double force = 0.0) {
    for (Side* side : {&quick_, &plain_}) {
      for (std::size_t i = 0; i < side->arms.size(); ++i) {
        side->holders[i].hold(q_d[i]);
        side->hands[i]->applyForces({force, force});
      }
      side->world.step();
    }
    ASSERT_EQ(plain_.world.stateHash(), quick_.world.stateHash())
        << "tick " << quick_.world.ticks();
    clear_ += implOf(quick_.world).clearance.isClear() ? 1 : 0;
    touches_ += contacts(plain_.world).size() > 4 ? 1 : 0;  // four carry the stone
  }

  Side quick_, plain_;
  int clear_{0}, touches_{0};
};

TEST_P(RobotClearanceTest, AFreeArmIsLeftOutOfTheSearch) {
  add(kind(), -0.5, 0, 0.3);
  for (int k = 0; k < 2000; ++k) {
    auto q_d = kHome;
    q_d[0] += 0.5 * std::sin(0.003 * k);
    q_d[3] += 0.2 * std::sin(0.004 * k);
    tick({q_d});
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_GT(clear_, 1800) << "of 2000 ticks";
  EXPECT_EQ(0, touches_);
}

/// Fast motions between random targets, among blocks, with a second arm in reach.
TEST_P(RobotClearanceTest, RandomMotionsAmongBlocksAreTheSameBitForBit) {
  add("one", -0.5, 0, 0.3);
  add("two", 0.5, 0.1, 0.3);
  addBlock("left", at(0.0, 0.45, 0.6));
  addBlock("right", at(0.0, -0.4, 0.5));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> turn(-1.2, 1.2);
  std::vector<std::array<double, 7>> target{kHome, kHome};
  target[1][0] = 3.0;
  for (int k = 0; k < 12000; ++k) {
    if (k % 400 == 399) {
      for (std::size_t arm = 0; arm < 2; ++arm) {
        for (std::size_t joint : {0U, 1U, 3U, 5U}) {
          target[arm][joint] = kHome[joint] + (arm == 1 && joint == 0 ? 3.0 : 0.0) + turn(random);
        }
      }
    }
    tick(target, k % 2000 < 1000 ? 2.0 : -2.0);
    ASSERT_FALSE(HasFatalFailure());
  }
  EXPECT_GT(clear_, 1000) << "of 12000 ticks";
  EXPECT_GT(touches_, 500) << "of 12000 ticks";
}

/// A world in which only robots move: then the search itself is left out.
class RobotsOnlyTest : public RobotClearanceTest {
 protected:
  RobotsOnlyTest() : RobotClearanceTest("empty") {}
};

TEST_P(RobotsOnlyTest, TwoArmsThatMeetAreTheSameBitForBit) {
  add("one", -0.5, 0, 0);
  add("two", 0.5, 0.1, 0);
  for (int k = 0; k < 6000; ++k) {
    std::vector<std::array<double, 7>> target{kHome, kHome};
    target[0][0] = std::sin(0.002 * k);
    target[0][1] = kHome[1] + 0.8 * std::sin(0.0013 * k);
    target[1][0] = 3.0 + std::sin(0.0017 * k);
    target[1][1] = kHome[1] + 0.8 * std::sin(0.0011 * k);
    tick(target);
    ASSERT_FALSE(HasFatalFailure());
    touches_ += contacts(plain_.world).empty() ? 0 : 1;
  }
  EXPECT_GT(clear_, 1000) << "of 6000 ticks";
  EXPECT_GT(touches_, 100) << "of 6000 ticks";
}

INSTANTIATE_TEST_SUITE_P(Robots, RobotsOnlyTest, ::testing::Values("fr3"));

TEST_P(RobotClearanceTest, ChangesFromOutsideAreSeen) {
  add(kind(), -0.5, 0, 0.3);
  for (int k = 0; k < 500; ++k) {
    tick({kHome});
  }
  ASSERT_TRUE(implOf(quick_.world).clearance.isClear());
  for (Side* side : {&quick_, &plain_}) {
    setBodyPose(side->world, "stone", bodyPose(side->world, kind() + "_hand_tcp"));
  }
  tick({kHome}, -2.0);
  EXPECT_FALSE(implOf(quick_.world).clearance.isClear());
  for (int k = 0; k < 1000; ++k) {
    tick({kHome}, -2.0);
  }
  addBlock("added", at(0.2, 0, 0.9));  // far away, then into the arm
  for (Side* side : {&quick_, &plain_}) {
    setJointPosition(side->world, kind() + "_joint1", 0.4);
  }
  for (int k = 0; k < 1000; ++k) {
    tick({kHome}, 2.0);
    ASSERT_FALSE(HasFatalFailure());
  }
}

/// The bound on the way of a robot's points, against MuJoCo's kinematics.
TEST_P(RobotClearanceTest, NoPointMovesFartherThanTheBound) {
  add(kind(), 0, 0, 0.3);
  World::Impl& impl = implOf(quick_.world);
  const mjModel& model = *impl.model;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-2.8, 2.8);
  std::uniform_real_distribution<double> opening(0.0, 0.04);
  const auto place = [&](std::vector<double>* centers, std::vector<double>* q) {
    for (int joint = 0; joint < model.njnt; ++joint) {
      if (impl.owners.robot_of_body[model.jnt_bodyid[joint]] >= 0) {
        const bool slides = model.jnt_type[joint] == mjJNT_SLIDE;
        impl.data->qpos[model.jnt_qposadr[joint]] = slides ? opening(random) : anywhere(random);
      }
    }
    mj_kinematics(&model, impl.data.get());
    centers->assign(impl.data->geom_xpos, impl.data->geom_xpos + 3 * model.ngeom);
    q->assign(impl.data->qpos, impl.data->qpos + model.nq);
  };
  std::vector<double> before, after, q_before, q_after;
  double tightest = 1e9;
  for (int trial = 0; trial < 2000; ++trial) {
    place(&before, &q_before);
    place(&after, &q_after);
    const double bound = impl.clearance.maxDisplacement(q_before.data(), q_after.data());
    for (int geom = 0; geom < model.ngeom; ++geom) {
      if (impl.owners.robot_of_geom[geom] >= 0) {
        const double way = mju_dist3(&before[3 * geom], &after[3 * geom]);
        ASSERT_LE(way, bound);
        tightest = std::min(tightest, bound / std::max(way, 1e-9));
      }
    }
  }
  EXPECT_LT(tightest, 5.0) << "a bound that is never near is useless";
}

INSTANTIATE_TEST_SUITE_P(Robots, RobotClearanceTest, ::testing::Values("panda"));

}  // namespace
}  // namespace franka_sim::test
