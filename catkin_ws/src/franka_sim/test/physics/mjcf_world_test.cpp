// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// World files by other authors: kept elements, and errors of refused ones.
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_cameras.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "physics/engine/model_compiler.h"
#include "temporary_folder.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

class MjcfWorldTest : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    return folder_.write(name, text);
  }
  void refuses(const std::string& text, std::initializer_list<const char*> parts) {
    const std::string file = write("bad.xml", text);
    expectSentence([&] { World world(file); }, parts);
    expectSentence([&] { World world(file); }, {file.c_str()});
  }

  franka_test::TemporaryFolder folder_;
};

TEST_F(MjcfWorldTest, ReportsErrorsWithTheirCause) {
  expectSentence([] { World world("/nowhere/world.xml"); }, {"/nowhere/world.xml", "opened"});
  expectSentence([] { World world("/tmp"); }, {"/tmp"});
  refuses("", {"not well-formed"});
  refuses("<mujoco><worldbody>", {"not well-formed"});
  refuses("<robot name='r'/>", {"<robot>", "<mujoco>", "<sdf>"});
  refuses("<mujoco><worldbody><geom type='cube'/></worldbody></mujoco>",
          {"MuJoCo refuses", "cube"});
  refuses("<mujoco><compiler settotalmass='3'/></mujoco>", {"settotalmass", "robots"});
  refuses("<mujoco><include file='gone.xml'/></mujoco>", {"gone.xml", "opened"});
  refuses("<mujoco><include file='bad.xml'/></mujoco>", {"bad.xml", "twice"});
  refuses("<mujoco><asset><mesh name='m' file='gone.stl'/></asset></mujoco>", {"gone.stl"});
}

TEST_F(MjcfWorldTest, UnitsAndDefaultsOfTheWorldDoNotAffectTheRobot) {
  const std::string file = write("world.xml", R"(<mujoco>
    <compiler angle="degree"/>
    <default><joint damping="7" armature="3" stiffness="5" frictionloss="2" limited="false"/>
      <geom friction="0.1" margin="0.1" gap="0.05" condim="1" contype="4"/></default>
    <option timestep="0.01" integrator="RK4" gravity="0 0 -1.62"/>
  </mujoco>)");
  World odd(file), plain;
  odd.addRobot(robot("panda"));
  plain.addRobot(robot("panda"));
  const auto a = physics::compile(odd.mjcf(false), "odd");
  const auto b = physics::compile(plain.mjcf(false), "plain");
  ASSERT_EQ(b->nv, a->nv);
  EXPECT_EQ(0.0005, a->opt.timestep);
  EXPECT_EQ(mjINT_EULER, a->opt.integrator);
  EXPECT_EQ((std::array<double, 3>{0, 0, -1.62}), gravity(odd));
  for (int i = 0; i < a->nv; ++i) {
    EXPECT_EQ(b->dof_damping[i], a->dof_damping[i]);
    EXPECT_EQ(b->dof_armature[i], a->dof_armature[i]);
    EXPECT_EQ(b->dof_frictionloss[i], a->dof_frictionloss[i]);
    EXPECT_EQ(b->jnt_stiffness[i], a->jnt_stiffness[i]);
    EXPECT_EQ(1, a->jnt_limited[i]);
    EXPECT_NEAR(b->jnt_range[2 * i], a->jnt_range[2 * i], 1e-14);
  }
  const int ours = mj_name2id(a.get(), mjOBJ_GEOM, "panda_leftfinger/collision_0");
  ASSERT_GE(ours, 0);
  EXPECT_EQ(1.13, a->geom_friction[3 * ours]);
  EXPECT_EQ(0.0, a->geom_margin[ours]);
  EXPECT_EQ(1, a->geom_contype[ours]);
}

TEST_F(MjcfWorldTest, KeyframesAreLeftOutWithANote) {
  World world(write("keys.xml", R"(<mujoco><worldbody>
    <body name="cube" pos="1 0 .1"><freejoint/><geom type="box" size=".02 .02 .02"/></body>
    </worldbody><keyframe><key name="home" qpos="1 0 .1 1 0 0 0"/></keyframe></mujoco>)"));
  world.addRobot(robot("panda"));
  EXPECT_NE(std::string::npos, world.unsupported().find("keyframe"));
}

/// MuJoCo 3 takes a joint with a range as limited.
TEST_F(MjcfWorldTest, RangesLimitJointsAsInMujoco3) {
  for (const char* compiler : {"", "<compiler autolimits='true'/>"}) {
    const World world(write("limits.xml", std::string("<mujoco>") + compiler + R"(<worldbody>
      <body><joint name="j" range="0 90"/><geom size="0.1"/></body></worldbody></mujoco>)"));
    const auto model = physics::compile(world.mjcf(false), "limits");
    EXPECT_EQ(1, model->jnt_limited[0]) << compiler;
    EXPECT_EQ("", world.unsupported());
  }
}

TEST_F(MjcfWorldTest, NotesThatRangesLimitDespiteTheFile) {
  const std::string text = R"(<mujoco><compiler autolimits="false"/><worldbody>
      <body><joint name="j" range="0 90"/><geom size="0.1"/></body></worldbody></mujoco>)";
  const World of_file(write("limits.xml", text));
  EXPECT_NE(std::string::npos, of_file.unsupported().find("autolimits")) << of_file.unsupported();
  World world;
  world.addObject("lever", text, Pose{});
  EXPECT_NE(std::string::npos, world.unsupported("lever").find("autolimits"));
  EXPECT_EQ(1, physics::compile(world.mjcf(false), "limits")->jnt_limited[0]);
}

TEST_F(MjcfWorldTest, BalancesInertiasOfTheWorldAlone) {
  const World world(write("balance.xml", R"(<mujoco><compiler balanceinertia="true"/><worldbody>
    <body name="b"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 4"/></body>
    </worldbody></mujoco>)"));
  const auto model = physics::compile(world.mjcf(false), "balance");
  EXPECT_DOUBLE_EQ(2, model->body_inertia[3]);
  EXPECT_EQ("", world.unsupported());
}

TEST_F(MjcfWorldTest, CamerasOfARobotBelongToTheWorld) {
  World world;
  RobotDescription description = robot("panda");
  description.urdf = replaceAll(
      description.urdf, "</robot>",
      "<gazebo reference='panda_hand'><sensor name='eye' type='camera'><camera><image><width>320"
      "</width><height>200</height></image></camera></sensor></gazebo></robot>");
  world.addRobot(description);
  ASSERT_EQ(1u, cameras(world).size());
  EXPECT_EQ("panda::panda_hand::eye", cameras(world)[0].name);
  EXPECT_EQ(320, cameras(world)[0].width);
  const auto model = physics::compile(world.mjcf(true), "pictures");
  EXPECT_EQ(1, model->ncam);
}

TEST_F(MjcfWorldTest, IncludesAndRelativeFilesWork) {
  write("rock.obj", "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write("rock.xml", R"(<mujoco><asset><mesh name="rock" file="rock.obj"/></asset><worldbody>
    <body name="rock" pos="2 0 0.5"><freejoint/><geom type="mesh" mesh="rock" mass="0.2"/></body>
    </worldbody></mujoco>)");
  World world(write("world.xml", R"(<mujoco><include file="rock.xml"/><worldbody>
    <geom type="plane" size="5 5 1"/></worldbody></mujoco>)"));
  world.addRobot(robot("panda"));
  run(world, 2000);
  const double z = bodyPose(world, "rock").position[2];
  EXPECT_GT(z, -0.01);
  EXPECT_LT(z, 0.2) << "it fell onto the ground";
}

TEST_F(MjcfWorldTest, EveryFreeBodyHasGraspContacts) {
  World world(write("world.xml", R"(<mujoco><worldbody>
    <geom name="floor" type="plane" size="5 5 1"/>
    <body name="a" pos="2 0 1"><freejoint/><geom size="0.03" friction="0.3 0.002 0.0001"/></body>
    <body name="b" pos="2 1 1"><freejoint/><geom name="b" size="0.03" friction="2"/></body>
    <body name="ghost" pos="2 2 1"><freejoint/><geom size="0.03" contype="0" conaffinity="0"/></body>
    </worldbody></mujoco>)"));
  world.addRobot(robot("panda"));
  const auto model = physics::compile(world.mjcf(false), "merged");
  int grasps = 0;
  for (int i = 0; i < model->npair; ++i) {
    const std::string geom = mj_id2name(model.get(), mjOBJ_GEOM, model->pair_geom1[i]);
    const std::string other = mj_id2name(model.get(), mjOBJ_GEOM, model->pair_geom2[i]);
    if ((geom + other).find("finger") == std::string::npos) {
      continue;
    }
    ++grasps;
    const double friction = model->pair_friction[5 * i];
    EXPECT_TRUE(friction == 0.3 || friction == 1.13) << "the more slippery side: " << friction;
    EXPECT_EQ(0.001, model->pair_solref[mjNREF * i]);
    EXPECT_EQ(4, model->pair_dim[i]);
  }
  EXPECT_EQ(2 * 2 * 4, grasps) << "two fingers of four pads with two bodies";
}

TEST_F(MjcfWorldTest, NamesAMissingCollisionMesh) {
  World world;
  RobotDescription description = robot("panda");
  const std::string box =
      "<collision><geometry><mesh filename=\"package://x/a.stl\"/></geometry></collision>";
  const std::string link = "<link name=\"panda_link5\">";
  ASSERT_NE(std::string::npos, description.urdf.find(link));
  description.urdf = replaceAll(description.urdf, link, link + box);
  expectSentence([&] { world.addRobot(description); },
                 {"'panda_link5'", "package://x/a.stl", "cannot be resolved"});
  description.resolve = [this](const std::string&) { return folder_ / "a.stl"; };
  expectSentence([&] { world.addRobot(description); }, {"a.stl", "does not exist"});
  write("a.stl", "solid ascii\nendsolid\n" + std::string(200, ' '));
  expectSentence([&] { world.addRobot(description); },
                 {"'panda_link5'", "a.stl", "cannot be read"});
  EXPECT_TRUE(world.robots().empty());
}

/// A visual that cannot be read shows the collision shapes instead of a gap.
TEST_F(MjcfWorldTest, MissingVisualMeshShowsTheCollisionShapes) {
  World world;
  RobotDescription description = robot("panda");
  const std::string mesh =
      "<visual><geometry><mesh filename=\"package://x/a.dae\"/></geometry></visual>";
  const std::string link = "<link name=\"panda_link5\">";
  description.urdf = replaceAll(description.urdf, link, link + mesh);
  world.addRobot(description);
  const auto model = physics::compile(world.mjcf(true), "the visual model");
  const int body = mj_name2id(model.get(), mjOBJ_BODY, "panda_link5");
  EXPECT_GT(model->body_geomnum[body], 0);
}

}  // namespace
}  // namespace franka_sim::test
