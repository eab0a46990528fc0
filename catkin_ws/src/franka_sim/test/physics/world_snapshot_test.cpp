// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Snapshots of other worlds: equal ones are restored, others are refused and change nothing. An
/// error of MuJoCo stops a world, not the process.

#include <memory>
#include <string>

#include "physics/world/world_impl.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

constexpr char kCubeOfSnapshot[] =
    R"(<body name="cube"><freejoint name="cube_joint"/>
         <geom type="box" size="0.05 0.05 0.05" mass="0.2"/></body>)";

class WorldSnapshotTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::unique_ptr<World> worldOf(const RobotDescription& description) const {
    auto made = std::make_unique<World>(world("stone"));
    made->addRobot(description);
    return made;
  }
  RobotDescription description() const {
    RobotDescription arm = robot(GetParam());
    arm.base.position = {-0.5, 0, 0};
    return arm;
  }
  ArmPlant& arm(World& world) const { return world.arm(GetParam(), GetParam()); }
  void push(World& world, double torque, int ticks) const {
    for (int i = 0; i < ticks; i++) {
      arm(world).applyTorques({torque, 0, 0, 0, 0, 0, torque});
      world.step();
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Robots, WorldSnapshotTest, ::testing::Values("panda", "fr3"),
                         [](const auto& param) { return std::string(param.param); });

TEST_P(WorldSnapshotTest, OfAnotherWorldIsRefusedAndChangesNothing) {
  const auto own = worldOf(description());
  push(*own, 2.0, 40);
  const std::uint64_t before = own->stateHash();

  RobotDescription elsewhere = description();
  elsewhere.base.position[1] = 0.1;
  RobotDescription heavier = description();
  heavier.link_errors[std::string(GetParam()) + "_link4"].mass = 0.01;
  RobotDescription rubbing = description();
  rubbing.friction[std::string(GetParam()) + "_joint1"].coulomb = 0.5;
  RobotDescription offset = description();
  offset.torque_offset[std::string(GetParam()) + "_joint3"] = 0.1;
  for (const RobotDescription& other : {elsewhere, heavier, rubbing, offset}) {
    const Snapshot snapshot = worldOf(other)->snapshot();
    expectSentence([&] { own->restore(snapshot); }, {"of another world", "Take another one"});
  }
  // As many changes as this world has had, so that their numbers would be equal in each of them.
  World smaller;
  smaller.addObject("cube", kCubeOfSnapshot, {{0, 0, 1}, {1, 0, 0, 0}});
  const Snapshot of_smaller = smaller.snapshot();
  expectSentence([&] { own->restore(of_smaller); }, {"of another world"});
  expectSentence([&] { smaller.restore(own->snapshot()); }, {"of another world"});
  EXPECT_EQ(own->stateHash(), before);
  push(*own, 2.0, 10);
}

/// MuJoCo's own handler would wait for the Enter key.
TEST(EngineErrors, StopTheWorldWithASentence) {
  const franka_test::TemporaryFolder folder;
  // Boxes that fall on each other need more of MuJoCo's stack than boxes in the air. MuJoCo refuses
  // files whose stack is too small for the beginning.
  std::string boxes;
  for (int i = 0; i < 8; i++) {
    boxes += "<body pos='0 0 " + franka_core::numberText(0.15 + 0.3 * i) +
             "'><freejoint/><geom type='box' size='.1 .1 .1'/></body>";
  }
  std::unique_ptr<World> world;
  for (int stack = 1000; !world && stack < 1000000; stack = stack * 11 / 10) {
    try {
      world = std::make_unique<World>(
          folder.write("narrow.xml", "<mujoco><size nstack='" + std::to_string(stack) +
                                         "'/><worldbody><geom type='plane' size='1 1 1'/>" + boxes +
                                         "</worldbody></mujoco>"));
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string::npos, std::string(error.what()).find("tack overflow")) << error.what();
    }
  }
  ASSERT_TRUE(world);
  for (int i = 0; i < 2; i++) {
    for (int k = 0; k < 2000 && !world->stopped(); k++) {
      world->prepareStep();
      world->step();
    }
    ASSERT_TRUE(world->stopped());
    EXPECT_EQ(0u, world->fault().find("MuJoCo has failed: ")) << world->fault();
    EXPECT_NE(std::string::npos, world->fault().find("tack overflow")) << world->fault();
    EXPECT_NE(std::string::npos, world->fault().find("until it is reset")) << world->fault();
    expectSentence([&] { world->snapshot(); }, {"MuJoCo has failed"});
    world->reset();
    EXPECT_FALSE(world->stopped());
  }
}

}  // namespace
}  // namespace franka_sim::test
