// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Objects that are added and removed, states that are set, snapshots that continue to the last bit.
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_gravity.h>
#include <franka_sim/physics/world_lights.h>
#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

#include "physics/world/world_impl.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kBall =
    "<body name='marble' pos='0 0 0.5'><freejoint/><geom type='sphere' size='0.05' mass='0.3'/>"
    "</body>";
constexpr const char* kCube =
    "<sdf version='1.6'><model name='any'><link name='link'><inertial><mass>0.5</mass><inertia>"
    "<ixx>0.001</ixx><iyy>0.001</iyy><izz>0.001</izz></inertia></inertial><collision name='c'>"
    "<geometry><box><size>0.1 0.1 0.1</size></box></geometry></collision></link></model></sdf>";

constexpr const char* kLamp =
    "<sdf version='1.6'><model name='any'><static>true</static><link name='link'>"
    "<pose>0 0 1 0 0 1.5707963267948966</pose><light name='bulb' type='point'>"
    "<pose>0 0 0.3 0 0 0</pose><diffuse>1 1 0.5 1</diffuse><attenuation><range>9</range>"
    "<constant>0.2</constant><linear>0.1</linear><quadratic>0.4</quadratic></attenuation></light>"
    "</link></model></sdf>";

void expectNear(const std::array<double, 3>& expected, const std::array<double, 3>& values) {
  test::expectNear(expected, values, 1e-6);
}

TEST(WorldObjects, LightsAreReadSetAndRemoved) {
  World world;
  WorldLight sun = light(world, "sun");
  expectNear({0.55, 0.55, 0.55}, sun.diffuse);
  EXPECT_TRUE(sun.shadows);
  sun.shadows = false;
  sun.diffuse = {1, 0.5, 0};
  sun.direction = {0, 0, -2};
  setLight(world, "sun", sun);
  world.addObject("lamp", kLamp, at(1, 0, 0));  // compiles the world again
  world.reset();
  EXPECT_FALSE(light(world, "sun").shadows);
  expectNear({1, 0.5, 0}, light(world, "sun").diffuse);
  expectNear({0, 0, -1}, light(world, "sun").direction);

  const std::string name = "lamp::link::bulb";
  WorldLight bulb = light(world, name);
  expectNear({0, 0, 0.3}, bulb.position);
  expectNear({0.2, 0.1, 0.4}, bulb.attenuation);
  bulb.position = {0, 0.25, 0};
  setLight(world, name, bulb);
  expectNear(bulb.position, light(world, name).position);
  // In the object's body: the link is turned by a quarter about z, 1 m above its origin.
  const mjModel& model = *implOf(world).model;
  const double* place = model.light_pos + 3 * mj_name2id(&model, mjOBJ_LIGHT, name.c_str());
  expectNear({-0.25, 0, 1}, {place[0], place[1], place[2]});
  bulb.on = false;
  setLight(world, name, bulb);
  expectSentence([&] { light(world, name); }, {name.c_str()});
  world.removeObject("lamp");
  world.addObject("lamp", kLamp, at(1, 0, 0));
  expectNear({0, 0, 0.3}, light(world, name).position);
}

TEST(WorldObjects, LightsRefuseImpossibleValues) {
  World world;
  const auto refuses = [&](const auto& change, const char* word) {
    WorldLight sun = light(world, "sun");
    change(sun);
    expectSentence([&] { setLight(world, "sun", sun); }, {"'sun'", word});
  };
  refuses([](WorldLight& sun) { sun.diffuse[1] = -0.1; }, "diffuse");
  refuses([](WorldLight& sun) { sun.specular[0] = std::nan(""); }, "specular");
  refuses([](WorldLight& sun) { sun.attenuation[2] = -1; }, "attenuation");
  refuses([](WorldLight& sun) { sun.position[0] = 1e9; }, "at most 1000 m");
  refuses([](WorldLight& sun) { sun.direction = {0, 0, 0}; }, "direction");
  expectSentence([&] { light(world, "moon"); }, {"'moon'"});
}

TEST(WorldObjects, AddAndRemoveKeepOtherStates) {
  World world;
  world.addObject("ball", kBall, at(1, 0, 0.5));
  EXPECT_DOUBLE_EQ(bodyPose(world, "ball").position[0], 1);
  EXPECT_DOUBLE_EQ(bodyPose(world, "ball").position[2], 1.0);
  run(world, 200);
  const double fallen = 1.0 - 0.5 * 9.81 * 0.2 * 0.2;
  EXPECT_NEAR(bodyPose(world, "marble").position[2], fallen, 1e-3);
  const Twist before = bodyState(world, "ball").twist;
  const Pose pose_before = bodyPose(world, "ball");
  world.addObject("cube", kCube, at(0, 1, 2));
  world.addObject("other cube", kCube, at(0, -1, 2));
  EXPECT_THAT(world.objects(), ElementsAre("ball", "cube", "other cube"));
  EXPECT_EQ(bodyPose(world, "ball").position, pose_before.position);
  EXPECT_NEAR(bodyState(world, "ball").twist.linear[2], before.linear[2], 1e-12);
  world.removeObject("ball");
  EXPECT_THROW(bodyPose(world, "ball"), std::runtime_error);
  run(world, 3000);
  EXPECT_NEAR(bodyPose(world, "cube").position[2], 0.05, 1e-3);
  EXPECT_NEAR(bodyPose(world, "other cube::link").position[1], -1, 1e-3);
}

constexpr const char* kUrdf =
    "<robot name='any'><link name='body'><inertial><mass value='0.5'/><inertia ixx='0.001' "
    "iyy='0.001' izz='0.001' ixy='0' ixz='0' iyz='0'/></inertial><collision><geometry>"
    "<box size='0.1 0.1 0.1'/></geometry></collision></link></robot>";

TEST(WorldObjects, UrdfOfAnObjectIsFreeToMove) {
  ASSERT_TRUE(isUrdfOfObject(kUrdf));
  World world;
  world.addObject("cube", kUrdf, at(1, 2, 1));
  EXPECT_EQ(bodyPose(world, "cube::body").position, (std::array<double, 3>{1, 2, 1}));
  run(world, 2000);
  EXPECT_NEAR(bodyPose(world, "cube").position[2], 0.05, 1e-3);
  setBodyPose(world, "cube", at(0, 0, 3));
}

TEST(WorldObjects, UrdfOfARobotIsNotOneOfAnObject) {
  const auto with = [](const std::string& element) {
    return replaceAll(kUrdf, "</robot>", element + "</robot>");
  };
  EXPECT_FALSE(isUrdfOfObject(with("<transmission name='t'/>")));
  EXPECT_FALSE(
      isUrdfOfObject(with("<link name='world'/><joint name='w' type='fixed'><parent "
                          "link='world'/><child link='body'/></joint>")));
  EXPECT_FALSE(isUrdfOfObject(
      with("<gazebo><plugin name='c' filename='libgazebo_ros_control.so'/></gazebo>")));
  for (const std::string kind : {"panda", "fr3"}) {
    EXPECT_FALSE(isUrdfOfObject(urdfOf(kind)));
  }
}

TEST(WorldObjects, UrdfJointsOfAnObjectMove) {
  World world;
  world.addObject("box",
                  replaceAll(kUrdf, "</robot>",
                             "<link name='lid'><inertial><mass value='0.1'/><inertia "
                             "ixx='0.001' iyy='0.001' izz='0.001'/></inertial></link>"
                             "<joint name='hinge' type='revolute'><parent link='body'/>"
                             "<child link='lid'/><limit lower='0' upper='2'/></joint>"
                             "</robot>"),
                  at(0, 0, 0.05));
  EXPECT_THAT(world.joints(), Contains("box::hinge"));
  EXPECT_THAT(world.bodies(), Contains("box::lid"));
}

TEST(WorldObjects, NamesThatAreTakenBeginWithTheObjects) {
  const char* pendulum =
      "<mujoco><asset><material name='red' rgba='1 0 0 1'/></asset><worldbody><body name='post'>"
      "<geom size='0.01' material='red'/><body name='rod'><joint name='hinge'/><geom name='rod' "
      "size='0.01' pos='0 0 -0.3'/></body></body></worldbody><contact><exclude name='e' "
      "body1='post' body2='rod'/></contact><equality><joint name='hinge' joint1='hinge' "
      "active='false'/></equality></mujoco>";
  World world;
  for (const char* name : {"first", "second", "post"}) {
    if (std::string(name) == "post") {
      world.removeObject("first");
    }
    world.addObject(name, pendulum, at(0, 0, 1));
  }
  EXPECT_THAT(world.joints(), ElementsAre("second::hinge", "hinge"));
  for (const char* body : {"post", "rod", "second", "second::rod"}) {
    EXPECT_THAT(world.bodies(), Contains(body));
  }
  EXPECT_THAT(world.unsupported("second"), HasSubstr("'second::'"));
  EXPECT_EQ("", world.unsupported("post"));
  // The object's name leads to its first body, also if that was renamed.
  world.addObject("third", replaceAll(pendulum, "'post'", "'third'"), at(0, 2, 1));
  EXPECT_EQ(2, bodyPose(world, "third").position[1]);
  EXPECT_EQ(2, bodyPose(world, "third::rod").position[1]);
}

TEST(WorldObjects, TextsThatGazeboTakesAreRead) {
  const std::string sdf = kCube, begin = "<sdf version='1.6'>", end = "</sdf>";
  World world;
  world.addObject("without end", sdf.substr(0, sdf.size() - end.size()), at(1, 0, 1));
  world.addObject("bare", sdf.substr(begin.size(), sdf.size() - begin.size() - end.size()),
                  at(2, 0, 1));
  EXPECT_THAT(world.objects(), ElementsAre("without end", "bare"));
}

TEST(WorldObjects, RoundedInertiasAreRepairedWithAWarning) {
  const std::string rounded = replaceAll(kCube, "<izz>0.001<", "<izz>0.00205<");
  const std::string mjcf =
      "<body name='disc'><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='0.001 0.001 "
      "0.00205'/></body>";
  World world;
  ASSERT_TRUE(world.takeWarnings().empty());
  for (const std::string& text : {rounded, mjcf}) {
    world.addObject("it", text, at(0, 0, 1));
    EXPECT_THAT(world.takeWarnings(), ElementsAre(world.unsupported("it")));
    EXPECT_THAT(world.unsupported("it"), ::testing::HasSubstr("inertia"));
    world.removeObject("it");
  }
  const std::string wrong = replaceAll(mjcf, "0.00205", "0.003");
  expectSentence([&] { world.addObject("it", wrong, at(0, 0, 1)); }, {"'disc'", "moments"});
}

TEST(WorldObjects, AnglesOfAnyUnitAreConverted) {
  const std::string file =
      "<mujoco>%<worldbody><body name='b' euler='0 0 @'><joint name='j' axis='0 0 1' range='0 @'/>"
      "<joint name='s' type='slide' range='0 90'/><geom size='0.1'/></body></worldbody></mujoco>";
  const std::string radians =
      replaceAll(replaceAll(file, "%", "<compiler angle='radian'/>"), "@", "1.5707963267948966");
  const std::string degrees = replaceAll(replaceAll(file, "%", ""), "@", "90");
  for (const std::string& text : {radians, degrees}) {
    World world;
    world.addObject("b", text, at(0, 0, 1));
    EXPECT_NEAR(bodyPose(world, "b").orientation[3], std::sqrt(0.5), 1e-12);
    const mjModel& model = *implOf(world).model;
    const int joint = mj_name2id(&model, mjOBJ_JOINT, "j");
    EXPECT_NEAR(model.jnt_range[2 * joint + 1], M_PI / 2, 1e-12);
    EXPECT_EQ(1, model.jnt_limited[joint]);
    EXPECT_EQ(90, model.jnt_range[2 * mj_name2id(&model, mjOBJ_JOINT, "s") + 1]);
  }
}

TEST(WorldObjects, ErrorsHaveACauseAndChangeNothing) {
  World world;
  world.addRobot(robot("panda"));
  world.addObject("ball", kBall, at(0, 0, 1));
  const auto refuses = [&](const char* name, const char* text,
                           std::initializer_list<const char*> parts) {
    expectSentence([&] { world.addObject(name, text, at(0, 0, 0)); }, parts);
  };
  refuses("", kCube, {"name"});
  refuses("ball", kCube, {"'ball'", "another name"});
  refuses("panda_link3", kCube, {"panda_link3", "another name"});
  refuses("panda", kCube, {"panda", "robot"});
  refuses("x", "", {"'x'", "well-formed"});
  refuses("x", "no xml", {"'x'", "well-formed"});
  refuses("x", "<part name='r'/>", {"<part>", "<sdf>", "<mujoco>"});
  refuses("x", "<mujoco/>", {"no body"});
  refuses("x", "<mujoco><option gravity='0 0 1'/></mujoco>", {"<option>", "whole world"});
  refuses("x", "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>", {"<body>"});
  refuses("x", "<body mocap='true'/>", {"mocap"});
  refuses("x", "<body><geom type='cube' size='1'/></body>", {"'x'", "cube"});
  refuses("x", "<sdf version='1.6'><model name='m'/></sdf>", {"'x'", "link"});
  Pose bad = at(NAN, 0, 0);
  expectSentence([&] { world.addObject("x", kCube, bad); }, {"pose"});
  expectSentence([&] { world.removeObject("nobody"); }, {"nobody"});
  EXPECT_THAT(world.objects(), ElementsAre("ball"));
  EXPECT_THAT(world.bodies(), Not(Contains("x")));
}

/// A change that is compiled while the world is stepped gives the same bits as one made at once.
TEST(WorldChanges, CompiledDuringTicksRepeatBitForBit) {
  const struct {
    const char* what;
    RobotDescription present;
    std::function<WorldChange(World&)> begin;
    std::function<void(World&)> at_once;
  } cells[] = {
      {"new object", robot("panda"),
       [](World& w) { return w.beginAddObject("cube", kUrdf, at(1, 1, 0.3)); },
       [](World& w) { w.addObject("cube", kUrdf, at(1, 1, 0.3)); }},
      {"new robot", robot("panda"), [](World& w) { return w.beginAddRobot(robot("fr3")); },
       [](World& w) { w.addRobot(robot("fr3")); }},
      {"object less", robot("fr3"), [](World& w) { return w.beginRemoveObject("other"); },
       [](World& w) { w.removeObject("other"); }},
      {"robot less", robot("fr3"), [](World& w) { return w.beginRemoveRobot("fr3"); },
       [](World& w) { w.removeRobot("fr3"); }},
  };
  for (const auto& cell : cells) {
    SCOPED_TRACE(cell.what);
    World stepped, at_once;
    for (World* world : {&stepped, &at_once}) {
      world->addRobot(cell.present);
      world->addObject("ball", kBall, at(-1, 0, 0.5));
      world->addObject("other", kUrdf, at(0, -1, 0.5));
    }
    WorldChange change = cell.begin(stepped);
    std::atomic<bool> compiled{false};
    std::thread thread([&] {
      change.compile();
      compiled = true;
    });
    int ticks = 0;
    for (; ticks < 10 || !compiled; ++ticks) {
      stepped.step();
    }
    thread.join();
    setGravity(stepped, {0, 0, -5});  // the model has been compiled before
    stepped.apply(change);
    run(at_once, ticks);
    setGravity(at_once, {0, 0, -5});
    cell.at_once(at_once);
    EXPECT_EQ(at_once.stateHash(), stepped.stateHash());
    run(stepped, 200);
    run(at_once, 200);
    EXPECT_EQ(at_once.stateHash(), stepped.stateHash());
  }
}

TEST(WorldChanges, AreNotAppliedAfterAnotherOne) {
  World world;
  WorldChange late = world.beginAddObject("cube", kUrdf, at(0, 1, 2));
  EXPECT_THROW(world.apply(late), std::logic_error) << "not compiled";
  late.compile();
  world.addObject("ball", kBall, at(1, 0, 0.5));
  const std::uint64_t before = world.stateHash();
  EXPECT_THROW(world.apply(late), std::logic_error);
  EXPECT_EQ(before, world.stateHash());
  EXPECT_THAT(world.objects(), ElementsAre("ball"));
}

/// A robot that was in the world for a moment before is the same to the last bit.
TEST(WorldChanges, ThatWereTakenBackAreMadeAgainWithTheSamePlants) {
  World visited, at_once;
  for (World* world : {&visited, &at_once}) {
    world->addObject("ball", kBall, at(1, 0, 0.5));
    run(*world, 100);
  }
  WorldChange change = visited.beginAddRobot(robot("panda"));
  change.compile();
  visited.apply(change);
  ArmPlant& arm = visited.arm("panda", "panda");
  HandPlant& hand = visited.hand("panda", "panda");
  const std::array<double, 7> q = arm.measure().q;
  arm.setBrakes(true);
  visited.apply(change);
  run(visited, 100);
  visited.apply(change);
  EXPECT_EQ(&arm, &visited.arm("panda", "panda"));
  EXPECT_EQ(&hand, &visited.hand("panda", "panda"));
  EXPECT_EQ(q, arm.measure().q);
  run(at_once, 100);
  at_once.addRobot(robot("panda"));
  at_once.arm("panda", "panda").setBrakes(true);
  EXPECT_EQ(at_once.stateHash(), visited.stateHash());
  run(visited, 200);
  run(at_once, 200);
  EXPECT_EQ(at_once.stateHash(), visited.stateHash());
}

TEST(WorldObjects, TwistsReferToTheBodysOrigin) {
  World world;
  setGravity(world, {0, 0, 0});
  // The center of mass is 0.2 m from the origin: rotation about it moves the origin.
  world.addObject("club",
                  "<body name='club'><freejoint/><inertial pos='0.2 0 0' mass='1' "
                  "diaginertia='0.01 0.01 0.01'/></body>",
                  at(0, 0, 1));
  Twist twist;
  twist.linear = {0.3, -0.2, 0.1};
  twist.angular = {0.5, 1.0, -2.0};
  Pose turned = at(1, 2, 3);
  turned.orientation = {std::cos(0.4), std::sin(0.4), 0, 0};
  setBodyPose(world, "club", turned);
  test::expectNear(turned.position, bodyPose(world, "club").position, 1e-15);
  test::expectNear(turned.orientation, bodyPose(world, "club").orientation, 1e-15);
  setBodyTwist(world, "club", twist);
  const Twist read = bodyState(world, "club").twist;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(read.linear[i], twist.linear[i], 1e-12);
    EXPECT_NEAR(read.angular[i], twist.angular[i], 1e-12);
  }
  // Finite differences of the pose.
  world.step();
  const Pose moved = bodyPose(world, "club");
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR((moved.position[i] - turned.position[i]) / World::kTick, twist.linear[i], 2e-3);
  }
}

TEST(WorldObjects, GravitySettingSurvivesChanges) {
  World world;
  world.addObject("cube", kCube, at(0, 0, 5));
  setGravity(world, {0, 0, -1.62});
  world.addObject("ball", kBall, at(1, 0, 5));
  run(world, 500);
  EXPECT_NEAR(bodyState(world, "cube").twist.linear[2], -1.62 * 0.5, 1e-9);
  world.reset();
  EXPECT_EQ(gravity(world)[2], -1.62);
  EXPECT_EQ(bodyPose(world, "cube").position[2], 5);
  expectSentence([&] { setGravity(world, {0, INFINITY, 0}); }, {"Gravity", "numbers"});
}

TEST(WorldObjects, SnapshotsOfAnotherWorldAreRefused) {
  World world;
  const Snapshot snapshot = world.snapshot();
  world.addObject("ball", kBall, at(1, 1, 1));
  expectSentence([&] { world.restore(snapshot); }, {"snapshot", "came or went"});
  expectSentence([&] { world.restore(Snapshot()); }, {"snapshot"});
}

}  // namespace
}  // namespace franka_sim::test
