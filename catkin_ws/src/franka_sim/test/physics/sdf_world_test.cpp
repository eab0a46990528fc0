// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// SDF worlds and models against closed forms: MuJoCo moves what the text describes.
#include <franka_sim/physics/world_bodies.h>
#include <franka_sim/physics/world_cameras.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/physics/world_pushes.h>
#include <gmock/gmock.h>
#include <source_file.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "sdf_test.h"

namespace franka_sim::test {
namespace {

using ::testing::HasSubstr;

constexpr double kGravity = 9.8;  ///< SDF's default

std::string box(const std::string& model, const std::string& pose, const std::string& surface,
                const std::string& more = "") {
  return "<model name='" + model + "'><pose>" + pose + "</pose><link name='link'>" +
         "<inertial><mass>2</mass><inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz>"
         "</inertia></inertial><collision name='c'><geometry><box><size>0.1 0.1 0.1</size></box>"
         "</geometry>" +
         surface + "</collision></link>" + more + "</model>";
}

std::string friction(double mu) {
  return "<surface><friction><ode><mu>" + franka_core::numberText(mu) + "</mu><mu2>" +
         franka_core::numberText(mu) + "</mu2></ode></friction></surface>";
}

std::string ground(double mu) {
  return "<model name='floor'><static>true</static><link name='link'><collision name='c'>"
         "<geometry><plane><normal>0 0 1</normal><size>5 5</size></plane></geometry>" +
         friction(mu) + "</collision></link></model>";
}

class SdfWorldTest : public SdfTest {};

TEST_F(SdfWorldTest, MjcfAndSdfStoneWorldsAgree) {
  World sdf(franka_test::sourceFile("franka_gazebo/world/stone.sdf"));
  World mjcf(world("stone"));
  EXPECT_EQ(sdf.unsupported(), "");
  for (const char* name : {"table", "pick_tray", "place_tray", "stone"}) {
    const mjModel &a = *implOf(sdf).model, &b = *implOf(mjcf).model;
    const int i = bodyId(sdf, name), j = bodyId(mjcf, name);
    ASSERT_GT(i, 0) << name;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(bodyPose(sdf, name).position[k], bodyPose(mjcf, name).position[k], 1e-15) << name;
    }
    EXPECT_DOUBLE_EQ(a.body_mass[i], b.body_mass[j]) << name;
    EXPECT_EQ(a.body_dofnum[i], b.body_dofnum[j]) << name;
    const int g = a.body_geomadr[i], h = b.body_geomadr[j];
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(a.geom_size[3 * g + k], b.geom_size[3 * h + k], 1e-15) << name;
      EXPECT_NEAR(a.geom_pos[3 * g + k], b.geom_pos[3 * h + k], 1e-15) << name;
      EXPECT_DOUBLE_EQ(a.geom_friction[3 * g + k], b.geom_friction[3 * h + k]) << name;
    }
    EXPECT_EQ(a.geom_solref[2 * g], b.geom_solref[2 * h]) << name;
    EXPECT_EQ(a.geom_priority[g], b.geom_priority[h]) << name;
  }
  run(sdf, 1000);
  run(mjcf, 1000);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(bodyPose(sdf, "stone").position[k], bodyPose(mjcf, "stone").position[k], 1e-6);
  }
}

TEST_F(SdfWorldTest, InertiasAndPosesMatchTheText) {
  World world(
      file("<model name='m'><pose>1 2 3 0 0 1.5707963267948966</pose><link name='a'>"
           "<pose>0.1 0 0 0 0.3 0</pose><inertial><pose>0.01 0.02 0.03 0.4 0.5 "
           "0.6</pose><mass>3.5</mass>"
           "<inertia><ixx>0.05</ixx><iyy>0.04</iyy><izz>0.03</izz><ixy>0.001</ixy><ixz>-0.002</ixz>"
           "<iyz>0.0015</iyz></inertia></inertial></link></model>"));
  const mjModel& model = *implOf(world).model;
  const int body = bodyId(world, "m");
  ASSERT_GT(body, 0);
  EXPECT_DOUBLE_EQ(model.body_mass[body], 3.5);
  const auto rpy = [](double r, double p, double y) -> Eigen::Matrix3d {
    return (Eigen::AngleAxisd(y, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(p, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(r, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  };
  // The link is posed in the model, its inertia frame in the link.
  const Eigen::Matrix3d link = rpy(0, 0.3, 0);
  const Eigen::Vector3d com = Eigen::Vector3d(0.1, 0, 0) + link * Eigen::Vector3d(0.01, 0.02, 0.03);
  EXPECT_LT((com - Eigen::Map<const Eigen::Vector3d>(model.body_ipos + 3 * body)).norm(), 1e-12);
  Eigen::Matrix3d moment;
  moment << 0.05, 0.001, -0.002, 0.001, 0.04, 0.0015, -0.002, 0.0015, 0.03;
  const Eigen::Matrix3d axes = link * rpy(0.4, 0.5, 0.6);
  const Eigen::Matrix3d expected = axes * moment * axes.transpose();
  const double* q = model.body_iquat + 4 * body;
  const Eigen::Matrix3d principal = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  const Eigen::Matrix3d actual =
      principal * Eigen::Map<const Eigen::Vector3d>(model.body_inertia + 3 * body).asDiagonal() *
      principal.transpose();
  EXPECT_LT((actual - expected).norm(), 1e-12);
  // 90 degrees about z: the link's x offset becomes the world's y.
  const Pose pose = bodyPose(world, "m::a");
  EXPECT_NEAR(pose.position[0], 1, 1e-12);
  EXPECT_NEAR(pose.position[1], 2.1, 1e-12);
  EXPECT_NEAR(pose.position[2], 3, 1e-12);
  EXPECT_NEAR(bodyPose(world, "m").position[1], 2, 1e-12);
}

/// On a slope a block rests below atan(mu) and slides above, where the floor decelerates it with mu
/// times its normal force. Gravity is tilted, not the floor. The more slippery of two surfaces
/// counts.
TEST_F(SdfWorldTest, FrictionDecidesOnASlope) {
  const double mu = 0.4;
  for (const double angle : {std::atan(mu) - 0.03, std::atan(mu) + 0.1}) {
    const std::string tilted = "<gravity>" + franka_core::numberText(kGravity * std::sin(angle)) +
                               " 0 " + franka_core::numberText(-kGravity * std::cos(angle)) +
                               "</gravity>";
    World world(file(tilted + ground(1.0) + box("b", "0 0 0.05 0 0 0", friction(mu))));
    run(world, 300);  // settles
    const double before = bodyState(world, "b").twist.linear[0];
    double along = 0, across = 0;
    for (int i = 0; i < 500; ++i) {
      world.step();
      for (const Contact& contact : contacts(world)) {
        along += contact.force[0];
        across += contact.force[2];
      }
    }
    if (angle < std::atan(mu)) {
      EXPECT_LT(std::abs(bodyState(world, "b").twist.linear[0] - before), 1e-3);
    } else {
      EXPECT_NEAR(along / across, -mu, 1e-4);
      EXPECT_GT(bodyState(world, "b").twist.linear[0] - before, 0.4);
    }
  }
}

/// Bodies collide if their masks share a bit; a body without one has all.
TEST_F(SdfWorldTest, BitmasksDecideWhichBodiesCollide) {
  const auto mask = [](int bits) {
    return "<surface><contact><collide_bitmask>" + std::to_string(bits) +
           "</collide_bitmask></contact></surface>";
  };
  const auto shelf = [&](const char* name, int x, int bits) {
    return box(name, std::to_string(x) + " 0 1 0 0 0", mask(bits), "<static>true</static>");
  };
  const auto above = [&](const char* name, int x, int bits) {
    return box(name, std::to_string(x) + " 0 1.1 0 0 0", mask(bits));
  };
  World world(file(ground(1) + shelf("s1", 0, 1) + above("other", 0, 2) + shelf("s2", 1, 3) +
                   above("shared", 1, 6) + box("none", "2 0 0.05 0 0 0", mask(0))));
  run(world, 1000);
  const auto height = [&](const char* name) { return bodyPose(world, name).position[2]; };
  EXPECT_NEAR(height("other"), 0.05, 1e-2) << "fell past its shelf, onto the ground";
  EXPECT_NEAR(height("shared"), 1.1, 1e-2);
  EXPECT_LT(height("none"), -1.0);
}

TEST_F(SdfWorldTest, SoftContactsDeflectByTheirStiffness) {
  const double kp = 2000;
  const std::string soft = "<surface><contact><ode><kp>2000</kp></ode></contact></surface>";
  World world(file(ground(1.0) + box("b", "0 0 0.05 0 0 0", soft)));
  run(world, 3000);
  // Four corners, each a spring: the box sinks by m g / (4 kp).
  const double depth = 0.05 - bodyPose(world, "b").position[2];
  EXPECT_NEAR(depth, 2 * kGravity / (4 * kp), 1e-3 * depth);
  EXPECT_EQ(contacts(world).size(), 4u);
  EXPECT_EQ(contacts(world).front().body1, "floor");
  EXPECT_NEAR(contacts(world).front().force[2], 2 * kGravity / 4, 1e-3);
  for (const Contact& corner : contacts(world)) {
    EXPECT_NEAR(std::abs(corner.position[0]), 0.05, 1e-3);
    EXPECT_NEAR(std::abs(corner.position[1]), 0.05, 1e-3);
    EXPECT_NEAR(corner.position[2], 0.0, depth);
  }
}

TEST_F(SdfWorldTest, HingesSwingLikeAPendulum) {
  // A point-like mass at 0.5 m: T = 2 pi sqrt((m l^2 + I) / (m g l)) for small swings.
  World world(file(
      "<model name='p'><pose>0 0 2 0 0 0</pose><link name='bob'><pose>0 0 -0.5 0 0 0</pose>"
      "<inertial><mass>1</mass><inertia><ixx>0.001</ixx><iyy>0.001</iyy><izz>0.001</izz></inertia>"
      "</inertial></link><joint name='pin' type='revolute'><pose>0 0 0.5 0 0 0</pose>"
      "<parent>world</parent><child>bob</child><axis><xyz>0 1 0</xyz>"
      "<limit><lower>-1</lower><upper>1.2</upper></limit></axis></joint></model>"));
  setJointPosition(world, "p::pin", 0.02);
  const double period = 2 * M_PI * std::sqrt((0.25 + 0.001) / (kGravity * 0.5));
  run(world, static_cast<int>(std::lround(period / 2 * 1000)));
  EXPECT_NEAR(jointState(world, "p::pin").position, -0.02, 1e-5);
  EXPECT_THROW(setJointPosition(world, "p::pin", 1.3), std::runtime_error);
  EXPECT_THROW(setJointPosition(world, "p::pin", -1.1), std::runtime_error);
}

TEST_F(SdfWorldTest, SlidesFallAlongTheirAxisAgainstDamping) {
  World world(file(
      "<model name='s'><link name='base'><inertial><mass>1</mass></inertial></link>"
      "<joint name='hold' type='fixed'><parent>world</parent><child>base</child></joint>"
      "<link name='cart'><pose>0 0 1 0 0 0</pose><inertial><mass>2</mass></inertial></link>"
      "<joint name='rail' type='prismatic'><parent>base</parent><child>cart</child>"
      "<axis><xyz>0 0 1</xyz><dynamics><damping>10</damping></dynamics></axis></joint></model>",
      "1.7"));
  run(world, 400);
  // m v' = -m g - d v
  const double expected = -2 * kGravity / 10 * (1 - std::exp(-10.0 / 2 * 0.4));
  EXPECT_NEAR(jointState(world, "s::rail").velocity, expected, 2e-3 * std::abs(expected));
  EXPECT_NEAR(bodyState(world, "s::cart").twist.linear[2], jointState(world, "s::rail").velocity,
              1e-9);
  EXPECT_DOUBLE_EQ(bodyPose(world, "s::base").position[2], 0);
}

TEST_F(SdfWorldTest, FixedJointsWeldAndModelsDoNotCollideWithThemselves) {
  const std::string two =
      "<link name='a'><inertial><mass>1</mass></inertial><collision name='c'><geometry><sphere>"
      "<radius>0.1</radius></sphere></geometry></collision></link>"
      "<link name='b'><pose>0.1 0 0 0 0 0</pose><inertial><mass>1</mass></inertial>"
      "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>"
      "</link>";
  World world(
      file("<gravity>0 0 0</gravity><model name='loose'>" + two +
           "</model><model name='touching'>"
           "<self_collide>true</self_collide><pose>0 2 0 0 0 0</pose>" +
           two + "</model><model name='welded'><pose>0 4 0 0 0 0</pose>" + two +
           "<joint name='w' type='fixed'><parent>a</parent><child>b</child></joint></model>"));
  run(world, 200);
  const auto apart = [&](const std::string& model) {
    return bodyPose(world, model + "::b").position[0] - bodyPose(world, model + "::a").position[0];
  };
  EXPECT_NEAR(apart("loose"), 0.1, 1e-9);
  EXPECT_GT(apart("touching"), 0.15);
  EXPECT_NEAR(apart("welded"), 0.1, 1e-12);
  pushBody(world, "welded::b", {2, 0, 0}, {0, 0, 0}, 1000);
  run(world, 1000);
  EXPECT_NEAR(bodyPose(world, "welded::a").position[0], 0.5 * 1.0 * 1.0, 2e-3);
}

TEST_F(SdfWorldTest, ReportsUnsupportedElementsInOneSentence) {
  World world(file(
      "<plugin name='wind_maker' filename='libw.so'/>" +
      box("b", "0 0 1 0 0 0",
          "<surface><bounce><restitution_coefficient>0.5</restitution_coefficient></bounce>"
          "<friction><ode><mu>0.8</mu><mu2>0.2</mu2></ode></friction></surface>",
          "<joint name='s' type='screw'><parent>world</parent><child>link</child>"
          "<axis><xyz>0 0 1</xyz></axis></joint>") +
      "<model name='lost'><link name='l'><visual name='v'><geometry><mesh><uri>model://gone/x.dae"
      "</uri></mesh></geometry></visual><sensor name='imu' type='imu'/></link></model>"));
  const std::string text = world.unsupported();
  for (const char* part :
       {"'wind_maker' (libw.so)", "bounce", "mu2", "joint 'b::s'", "gone/x.dae", "imu"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_DOUBLE_EQ(
      implOf(world).model->geom_friction[3 * implOf(world).model->body_geomadr[bodyId(world, "b")]],
      0.2);
}

/// The other errors are those of SdfTextTest.
TEST_F(SdfWorldTest, ReportsErrorsWithTheirFileAndCause) {
  const std::pair<const char*, const char*> errors[] = {
      {"<sdf version='1.6'/>", "<world>"},
      {"<sdf version='1.6'><world name='w'>", "well-formed"},
      {"<sdf version='1.6'><world name='w'><model name='m'/></world></sdf>", "link"},
  };
  for (const auto& [text, cause] : errors) {
    const std::string file = write("bad.sdf", text);
    expectSentence([&] { World world(file); }, {cause, file.c_str()});
  }
}

/// A robot with self_collide false passes through itself: the hand through the forearm. As in
/// Gazebo, one of two links decides: here the link of the hand.
TEST_F(SdfWorldTest, ReadsSelfCollideOfAUrdfAndOfItsLinks) {
  const std::string off = "<gazebo><self_collide>false</self_collide></gazebo>";
  const auto link = [&off](const std::string& name) {
    return off + "<gazebo reference='" + name + "'><selfCollide>true</selfCollide></gazebo>";
  };
  for (const auto& [settings, collides] :
       {std::pair{std::string("<gazebo><self_collide>true</self_collide></gazebo>"), true},
        std::pair{off, false}, std::pair{link("panda_hand"), true},
        std::pair{link("panda_link1"), false}}) {
    World world;
    RobotDescription arm = robot("panda");
    arm.urdf = replaceAll(arm.urdf, "</robot>", settings + "</robot>");
    arm.initial_positions["panda_joint6"] = -0.5;
    arm.initial_positions["panda_joint4"] = -3.0;
    world.addRobot(arm);
    world.step();
    const auto found = contacts(world);
    EXPECT_EQ(collides, std::any_of(found.begin(), found.end(),
                                    [](const Contact& contact) {
                                      return contact.body1.rfind("panda", 0) == 0 &&
                                             contact.body2.rfind("panda", 0) == 0;
                                    }))
        << settings;
  }
}

/// Fingers of one hand pass through each other, those of two hands do not.
TEST_F(SdfWorldTest, ArmsOfOneDescriptionCollide) {
  RobotDescription both = twoArms("<origin xyz='0.614 0.02 0.02' rpy='0 0 3.14159265'/>");
  both.urdf = replaceAll(both.urdf, "<link name='world'/>",
                         "<link name='world'/><gazebo><self_collide>true</self_collide></gazebo>");
  World world;
  world.addRobot(both);
  world.step();
  int within = 0, between = 0;
  for (const Contact& contact : contacts(world)) {
    if (contact.body1.find("finger") != std::string::npos &&
        contact.body2.find("finger") != std::string::npos) {
      ++(contact.body1[0] == contact.body2[0] ? within : between);
    }
  }
  EXPECT_GT(between, 0);
  EXPECT_EQ(within, 0);
}

TEST_F(SdfWorldTest, CamerasKeepTheirViewAndSize) {
  World world(file(
      "<model name='m'><static>true</static><pose>0 0 1 0 0 0</pose><link name='l'>"
      "<sensor name='eye' type='camera'><update_rate>5</update_rate><camera>"
      "<horizontal_fov>1.2</horizontal_fov><image><width>320</width><height>200</height></image>"
      "</camera></sensor></link></model>"));
  const auto found = cameras(world);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "m::l::eye");
  EXPECT_EQ(found[0].width, 320);
  EXPECT_EQ(found[0].height, 200);
  EXPECT_DOUBLE_EQ(found[0].rate, 5);
  EXPECT_NEAR(found[0].field_of_view, 2 * std::atan(std::tan(0.6) * 200 / 320) * 180 / M_PI, 1e-9);
  // The camera looks along the link's x; MuJoCo's cameras look along their -z.
  const double* q = implOf(world).model->cam_quat;
  const Eigen::Matrix3d turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  EXPECT_LT((turn * -Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((turn * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

}  // namespace
}  // namespace franka_sim::test
