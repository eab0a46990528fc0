// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/urdf/urdf_robot.h"

#include <franka_sim/robot/control_unit_parameters.h>

#include <cmath>

#include "physics/mjcf/robot_model.h"
#include "physics/urdf/urdf_reader.h"
#include "test_support.h"

namespace franka_sim::test {
namespace {

constexpr const char* kLinkInertial =
    "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' "
    "iyz='0'/></inertial>";

/// base -j-> arm, with the given joint.
std::string twoLinks(const std::string& joint, const std::string& arm = kLinkInertial) {
  return "<robot name='r'><link name='base'/><link name='arm'>" + arm + "</link>" + joint +
         "</robot>";
}

std::string hinge(const std::string& inside = "<limit lower='-1' upper='1'/>") {
  return "<joint name='j' type='revolute'><parent link='base'/><child link='arm'/>" + inside +
         "</joint>";
}

void refuses(const std::string& urdf, std::initializer_list<const char*> parts) {
  expectSentence([&] { physics::readUrdf(urdf, "rob"); }, parts);
}

TEST(UrdfRobotTest, ReadsThePanda) {
  const physics::UrdfRobot robot = physics::readUrdf(urdfOf("panda"), "panda");
  EXPECT_EQ("panda_link0", robot.links[robot.root].name);
  const auto& joint4 = robot.joints[robot.joint("panda_joint4")];
  EXPECT_EQ(physics::UrdfJoint::Type::kRevolute, joint4.type);
  EXPECT_EQ(0.0825, joint4.origin.translation().x());
  EXPECT_EQ(-3.0718, joint4.lower);
  const auto& finger = robot.joints[robot.joint("panda_finger_joint2")];
  EXPECT_EQ("panda_finger_joint1", finger.mimic);
  EXPECT_EQ(-1.0, finger.axis.y());
  EXPECT_EQ(1.13, robot.links[robot.link("panda_leftfinger")].friction.value());
  EXPECT_TRUE(robot.self_collide);
  EXPECT_FALSE(robot.links[robot.link("panda_link3")].friction.has_value());
  EXPECT_EQ(4u, robot.links[robot.link("panda_leftfinger")].collisions.size());
  EXPECT_TRUE(robot.links[robot.link("panda_link3_sc")].collisions.empty());
}

TEST(UrdfRobotTest, RollPitchYawUsesFixedAxes) {
  const auto robot = physics::readUrdf(
      twoLinks(hinge("<origin rpy='0.3 -0.4 0.5'/><limit lower='-1' upper='1'/>")), "rob");
  const Eigen::Matrix3d r = robot.joints[0].origin.linear();
  // Closed form of Rz(yaw) Ry(pitch) Rx(roll).
  EXPECT_NEAR(std::cos(0.5) * std::cos(-0.4), r(0, 0), 1e-15);
  EXPECT_NEAR(-std::sin(-0.4), r(2, 0), 1e-15);
  EXPECT_NEAR(std::cos(-0.4) * std::sin(0.3), r(2, 1), 1e-15);
  EXPECT_NEAR(std::sin(0.5) * std::cos(-0.4), r(1, 0), 1e-15);
}

TEST(UrdfRobotTest, ReportsErrorsWithTheirCause) {
  refuses("", {"'rob'", "XML"});
  refuses("<robot><link name='a'></robot>", {"'rob'", "not well-formed"});
  refuses("<mujoco/>", {"no <robot>"});
  refuses("<robot name='r'><link name='a'/><link name='a'/></robot>", {"two links", "'a'"});
  refuses("<robot name='r'><link/></robot>", {"<link>", "'name'"});
  refuses("<robot name='r'><link name='a'/><link name='b'/></robot>", {"no parent", "'a'", "'b'"});
  refuses(twoLinks("<joint name='j' type='ball'><parent link='base'/><child link='arm'/></joint>"),
          {"joint 'j'", "'ball'"});
  refuses(twoLinks("<joint name='j' type='fixed'><parent link='base'/></joint>"),
          {"joint 'j'", "<child>"});
  refuses(twoLinks("<joint name='j' type='fixed'><parent link='bas'/><child link='arm'/></joint>"),
          {"parent link 'bas'", "not exist"});
  refuses(twoLinks(hinge("<limit lower='1' upper='-1'/>")), {"lower limit 1", "upper limit -1"});
  refuses(twoLinks(hinge("<axis xyz='0 0 0'/><limit lower='-1' upper='1'/>")), {"axis"});
  refuses(twoLinks(hinge("<axis xyz='0 1'/><limit lower='-1' upper='1'/>")), {"'xyz'", "needs 3"});
  refuses(twoLinks(hinge("<origin xyz='0 0 nan'/><limit lower='-1' upper='1'/>")),
          {"'nan'", "finite"});
  refuses(twoLinks(hinge("<mimic joint='k'/><limit lower='-1' upper='1'/>")), {"mimics 'k'"});
  refuses(twoLinks(hinge("<mimic joint='j'/><limit lower='-1' upper='1'/>")), {"mimics 'j'"});
  refuses(twoLinks(hinge(),
                   "<inertial><mass value='-1'/><inertia ixx='1' iyy='1' izz='1'/></inertial>"),
          {"link 'arm'", "negative"});
  refuses(
      twoLinks(hinge(), "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='3'/></inertial>"),
      {"link 'arm'", "principal moments"});
  refuses(twoLinks(hinge(), "<inertial><mass value='1'/></inertial>"), {"<inertia>"});
  refuses(twoLinks(hinge(), "<collision/>"), {"link 'arm'", "has no geometry"});
  refuses(twoLinks(hinge(), "<collision><geometry><cone/></geometry></collision>"), {"<cone>"});
  refuses(twoLinks(hinge(), "<collision><geometry><sphere radius='0'/></geometry></collision>"),
          {"'radius'", "greater than zero"});
  refuses(twoLinks(hinge(), "<visual><geometry><mesh/></geometry></visual>"), {"'filename'"});
}

TEST(UrdfRobotTest, HoldsJointsWithoutARange) {
  for (const char* limit : {"", "<limit effort='1'/>", "<limit lower='0' upper='0'/>"}) {
    const auto robot = physics::readUrdf(twoLinks(hinge(limit)), "rob");
    EXPECT_EQ(physics::UrdfJoint::Type::kFixed, robot.joints[0].type) << limit;
    EXPECT_TRUE(robot.joints[0].origin.isApprox(Eigen::Isometry3d::Identity())) << limit;
    EXPECT_EQ(1u, robot.notes.size()) << limit;
  }
}

TEST(UrdfRobotTest, HeldJointsKeepThePositionOfTheirLimits) {
  const std::string origin = "<origin xyz='1 2 3' rpy='0.3 -0.4 0.5'/><axis xyz='0 0 2'/>";
  const auto robot =
      physics::readUrdf(twoLinks(hinge(origin + "<limit lower='0.6' upper='0.6'/>")), "rob");
  const auto free =
      physics::readUrdf(twoLinks(hinge(origin + "<limit lower='0' upper='1'/>")), "rob");
  EXPECT_TRUE(robot.joints[0].origin.isApprox(
      free.joints[0].origin * Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ()), 1e-12));
}

TEST(UrdfRobotTest, HoldsTheFollowerOfAHeldJoint) {
  const auto robot = physics::readUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='k' type='prismatic'><parent link='b'/><child link='c'/><limit lower='-1' "
      "upper='1'/><mimic joint='j' multiplier='2' offset='0.1'/></joint>"
      "<joint name='j' type='revolute'><parent link='a'/><child link='b'/>"
      "<limit lower='0.2' upper='0.2'/></joint></robot>",
      "rob");
  EXPECT_EQ(physics::UrdfJoint::Type::kFixed, robot.joints[0].type);
  EXPECT_NEAR(0.5, robot.joints[0].origin.translation().x(), 1e-15);
}

TEST(UrdfRobotTest, NamesNoPluginThatFollowsAMimic) {
  const auto robot = physics::readUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='k' type='prismatic'><parent link='b'/><child link='c'/><limit lower='-1' "
      "upper='1'/><mimic joint='j'/></joint><joint name='j' type='revolute'><parent link='a'/>"
      "<child link='b'/><limit lower='0' upper='1'/></joint><gazebo><plugin name='m' "
      "filename='libmimic.so'><joint>j</joint><mimicJoint>k</mimicJoint></plugin></gazebo></robot>",
      "rob");
  EXPECT_EQ(std::set<std::string>(), robot.notes);
}

TEST(UrdfRobotTest, RepairsRoundedInertiasWithANote) {
  const auto moments = [](double xx, double yy, double zz) {
    return "<inertial><mass value='1'/><inertia ixx='" + franka_core::numberText(xx) + "' iyy='" +
           franka_core::numberText(yy) + "' izz='" + franka_core::numberText(zz) + "'/></inertial>";
  };
  const auto robot = physics::readUrdf(twoLinks(hinge(), moments(0.42, 0.42, 0.85)), "rob");
  const Eigen::Matrix3d& inertia = robot.links[1].inertial->inertia;
  EXPECT_NEAR(0.84, inertia(2, 2), 1e-9);
  EXPECT_EQ(0.42, inertia(0, 0));
  ASSERT_EQ(1u, robot.notes.size());
  EXPECT_NE(std::string::npos, robot.notes.begin()->find("'arm'"));
  EXPECT_TRUE(physics::readUrdf(twoLinks(hinge(), moments(1, 1, 2)), "rob").notes.empty());
  EXPECT_EQ(1u, physics::readUrdf(twoLinks(hinge(), moments(-0.01, 1, 1)), "rob").notes.size());
  refuses(twoLinks(hinge(), moments(1, 1, 2.2)), {"link 'arm'", "principal moments"});
}

TEST(UrdfRobotTest, ReadsCamerasAndNamesWhatIsNotSimulated) {
  const auto robot = physics::readUrdf(
      twoLinks(hinge() +
               "<gazebo reference='arm'><sensor name='eye' type='depth'><pose>1 0 0 0 0 0</pose>"
               "<update_rate>5</update_rate><camera><image><width>64</width><height>48</height>"
               "</image></camera></sensor><sensor name='bump' type='contact'/></gazebo>"
               "<gazebo><plugin name='truth' filename='libgazebo_ros_p3d.so'/></gazebo>"),
      "rob");
  const auto& cameras = robot.links[robot.link("arm")].cameras;
  ASSERT_EQ(1u, cameras.size());
  EXPECT_EQ("rob::arm::eye", cameras[0].name);
  EXPECT_EQ(64, cameras[0].width);
  EXPECT_EQ(5, cameras[0].rate);
  EXPECT_EQ(1, cameras[0].pose.translation().x());
  ASSERT_EQ(2u, robot.notes.size());
  EXPECT_NE(std::string::npos, robot.notes.begin()->find("truth"));
  EXPECT_NE(std::string::npos, robot.notes.rbegin()->find("rob::arm::bump"));
}

TEST(UrdfRobotTest, NamesSettingsOfGazeboThatHaveNoEffect) {
  const auto notesOf = [](const std::string& settings) {
    const auto notes = physics::readUrdf(twoLinks(hinge() + settings), "rob").notes;
    return std::vector<std::string>(notes.begin(), notes.end());
  };
  using List = std::vector<std::string>;
  const auto of = [](const std::string& name, const std::string& settings) {
    return "<gazebo reference='" + name + "'>" + settings + "</gazebo>";
  };
  EXPECT_EQ(List{"gravity that is off, of 'j'"}, notesOf(of("j", "<gravity>0</gravity>")));
  EXPECT_EQ((List{"<kd> of 'arm'", "<kp> of 'arm'", "<mu2> of 'arm'"}),
            notesOf(of("arm", "<mu1>1</mu1><mu2>1</mu2><kp>1e6</kp><kd>1</kd>")));
  EXPECT_EQ(
      (List{"<kp> of a collision of 'arm'", "<mu2> of a collision of 'arm'"}),
      notesOf(of("arm",
                 "<collision><max_contacts>9</max_contacts><surface><contact><ode><kp>1e6</kp>"
                 "<min_depth>0.1</min_depth></ode></contact><friction><ode><mu>1</mu>"
                 "<mu2>2</mu2></ode></friction></surface></collision>")));
  EXPECT_EQ(List{}, notesOf(of("arm", "<selfCollide>true</selfCollide>")));
  EXPECT_EQ(List{"<self_collide> of 'j'"}, notesOf(of("j", "<self_collide>1</self_collide>")));
  EXPECT_EQ(List{"<stopKd> of 'j'"}, notesOf(of("j", "<stopKd>1</stopKd>")));
  EXPECT_EQ(List{"<gazebo> of 'amr', which is neither a link nor a joint"},
            notesOf(of("amr", "<gravity>0</gravity>")));
  const std::string follows =
      "<gazebo><plugin name='m' filename='libroboticsgroup_gazebo_mimic_joint_plugin.so'>"
      "<joint>j</joint><mimicJoint>j</mimicJoint></plugin></gazebo>";
  EXPECT_EQ(List{"plugin 'm' (libroboticsgroup_gazebo_mimic_joint_plugin.so)"}, notesOf(follows));
  EXPECT_EQ(List{"<pose> of the model"}, notesOf("<gazebo><pose>0 0 1 0 0 0</pose></gazebo>"));
  EXPECT_EQ(List{}, notesOf(of("arm",
                               "<mu1>1</mu1><turnGravityOff>true</turnGravityOff>"
                               "<collision><surface/></collision>") +
                            of("j", "<provideFeedback>true</provideFeedback>") +
                            "<gazebo><static>false</static></gazebo>"));
}

TEST(UrdfRobotTest, HasGazebosDefaultOfSelfCollisionIfItWasWrittenForGazebo) {
  const auto of = [](const std::string& settings) {
    return physics::readUrdf(twoLinks(hinge() + settings), "rob");
  };
  const std::string plugin =
      "<gazebo><plugin name='control' filename='libgazebo_ros_control.so'/></gazebo>";
  EXPECT_TRUE(of("").self_collide);
  EXPECT_FALSE(of(plugin).self_collide);
  for (const std::string name : {"self_collide", "selfCollide"}) {
    const auto setting = [&name](const std::string& value) {
      return "<" + name + ">" + value + "</" + name + "></gazebo>";
    };
    EXPECT_TRUE(of(plugin + "<gazebo>" + setting("true")).self_collide);
    EXPECT_TRUE(of("<gazebo>" + setting("1") + plugin).self_collide);
    EXPECT_FALSE(of("<gazebo>" + setting("false")).self_collide);
    const physics::UrdfRobot robot = of(plugin + "<gazebo reference='arm'>" + setting("true"));
    EXPECT_TRUE(robot.links[robot.link("arm")].self_collide.value_or(false));
    EXPECT_FALSE(robot.self_collide);
    refuses(twoLinks(hinge() + "<gazebo>" + setting("maybe")), {name.c_str(), "true or false"});
  }
}

TEST(UrdfRobotTest, RefusesLoopsAndTwoParents) {
  const std::string loop =
      "<robot name='r'><link name='root'/><link name='a'/><link name='b'/>"
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
      "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>";
  refuses(loop, {"loop"});
  refuses(twoLinks(hinge() +
                   "<joint name='k' type='fixed'><parent link='base'/><child link='arm'/></joint>"),
          {"'arm'", "two parent joints", "'j'", "'k'"});
}

TEST(RobotModelTest, RefusesParametersThatDoNotFitTheUrdf) {
  using Robot = RobotDescription;
  const auto refusesRobot = [](void (*change)(Robot&), std::initializer_list<const char*> parts) {
    Robot description = robot("panda");
    change(description);
    expectSentence([&] { physics::buildRobot(description); }, parts);
  };
  refusesRobot([](Robot& d) { d.name = ""; }, {"needs a name"});
  refusesRobot([](Robot& d) { d.rotor_inertia["panda_joint9"] = 1; },
               {"rotor inertia", "'panda_joint9'"});
  refusesRobot([](Robot& d) { d.friction["panda_joint1"].viscous = -1; },
               {"viscous friction", "-1"});
  refusesRobot([](Robot& d) { d.friction["panda_joint9"].offset = 1; },
               {"friction", "'panda_joint9'"});
  refusesRobot([](Robot& d) { d.torque_offset["panda_joint2"] = NAN; },
               {"torque sensor", "panda_joint2"});
  refusesRobot([](Robot& d) { d.link_errors["panda_link3"].mass = -1; },
               {"panda_link3", "no mass"});
  refusesRobot([](Robot& d) { d.link_errors["panda_link9"].mass = 0.1; }, {"panda_link9"});
  refusesRobot([](Robot& d) { d.initial_positions["panda_joint2"] = NAN; },
               {"initial position", "panda_joint2"});
  refusesRobot([](Robot& d) { d.stops["panda_joint2"] = {1, -1}; }, {"stops", "panda_joint2"});
  refusesRobot([](Robot& d) { d.initial_positions["panda_finger_joint1"] = 0.05; },
               {"panda_finger_joint1", "cannot start at 0.05", "0.04"});
  refusesRobot([](Robot& d) { d.base.orientation = {0, 0, 0, 0}; }, {"base", "quaternion"});
  refusesRobot(
      [](Robot& d) {
        d = {};
        d.name = "panda";
        d.urdf = twoLinks(hinge(), "");
      },
      {"'arm'", "no mass", "gazebo:=true"});
}

TEST(RobotModelTest, FusesFixedLinks) {
  const physics::RobotModel model = physics::buildRobot(robot("panda"));
  EXPECT_EQ(10u, model.segments.size()) << "link0, seven links, two fingers";
  for (const physics::Segment& segment : model.segments) {
    if (model.urdf.links[segment.link].name == "panda_link7") {
      EXPECT_NEAR(0.735522 + 0.73, segment.inertial.mass, 1e-15);
    }
  }
}

// An encoder never shows the exact target, and clients divide by the remaining distance.
TEST(RestOffset, IsATenthOfAMilliradianFromTheTarget) {
  RobotDescription description = robot("panda");
  description.initial_positions.erase("panda_joint3");
  const auto target = description.initial_positions;
  applyRestOffset(kJointStiffness, "panda", description);
  EXPECT_EQ(target.size(), description.initial_positions.size());
  for (const auto& [joint, position] : target) {
    const double way = std::abs(description.initial_positions[joint] - position);
    EXPECT_GT(way, 1e-5) << joint;
    EXPECT_LT(way, 2e-4) << joint;
  }
}

}  // namespace
}  // namespace franka_sim::test
