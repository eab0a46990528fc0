// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// A mobile base with two drive modules: its description, and errors of other robots.
#include <franka/mobile_model.h>
#include <franka/model.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "random_state.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

using franka::MobileFrame;
using franka::MobileModel;

std::string joint(int number, const std::string& parent, const std::string& child,
                  const std::string& origin, const std::string& axis) {
  return "<joint name='tmr_joint_" + std::to_string(number) + "' type='continuous'><parent link='" +
         parent + "'/><child link='" + child + "'/><origin " + origin + "/><axis xyz='" + axis +
         "'/></joint>";
}

std::string baseWith(const std::string& last_joint) {
  return "<robot name='tmrv0_2'><link name='base'/><link name='a'/><link name='b'/>"
         "<link name='c'/><link name='d'/>" +
         joint(0, "base", "a", "xyz='0.3 0.2 0.1'", "0 0 1") +
         joint(1, "a", "b", "xyz='0 0 -0.05'", "0 1 0") +
         joint(2, "base", "c", "xyz='-0.3 -0.2 0.1' rpy='0 0 0'", "0 0 2") + last_joint +
         "</robot>";
}

const std::string kBase = baseWith(joint(3, "c", "d", "xyz='0 0 -0.05'", "0 1 0"));

// Poses computed by hand; libfranka 0.21.2 printed the same four digits.
TEST(MobileModel, ComputesPosesOfItsDriveModules) {
  const MobileModel base(kBase);
  for (int module : {0, 1}) {
    const double sign = module == 0 ? 1.0 : -1.0;
    const auto pose = base.pose(static_cast<MobileFrame>(module), {0.1, 0.2, 0.3, 0.4});
    const Eigen::Matrix4d T = Eigen::Matrix4d::Map(pose.data());
    const Eigen::Matrix3d R =
        (Eigen::AngleAxisd(module == 0 ? 0.1 : 0.3, Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(module == 0 ? 0.2 : 0.4, Eigen::Vector3d::UnitY()))
            .toRotationMatrix();
    EXPECT_LT((T.topLeftCorner<3, 3>() - R).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((T.topRightCorner<3, 1>() - Eigen::Vector3d(0.3 * sign, 0.2 * sign, 0.05)).norm(),
              1e-15);
    EXPECT_EQ(Eigen::RowVector4d(0, 0, 0, 1), T.row(3));
  }
  EXPECT_THROW(base.pose(static_cast<MobileFrame>(2), {}), std::invalid_argument);
}

TEST(MobileModel, RefusesOtherDescriptionsWithASentence) {
  const std::string begin = "libfranka: The model of a mobile base cannot be made. ";
  const auto refusal = [](const std::string& urdf) {
    return textOf<franka::ModelException>([&] { MobileModel model(urdf); });
  };
  EXPECT_TRUE(startsWith(refusal(readData("fr3_hand.urdf")),
                         begin + "The description (URDF) is of the robot \"fr3\""));
  EXPECT_TRUE(startsWith(refusal("no XML"), begin + "Its description (URDF) cannot be read"));
  const std::string fixed =
      "<joint name='j' type='fixed'><parent link='c'/><child link='d'/></joint>";
  EXPECT_TRUE(
      startsWith(refusal(baseWith(fixed)),
                 begin + "Its description (URDF) has no joint whose name ends with _joint_3."));
  const std::string wrong[] = {
      joint(3, "c", "d", "xyz='0 zero 0'", "0 1 0"), joint(3, "c", "d", "xyz='0 0 0'", "0 0 0"),
      joint(3, "d", "d", "xyz='0 0 0'", "0 1 0"), joint(3, "c", "d", "xyz='0 0 nan'", "0 1 0")};
  for (const std::string& last_joint : wrong) {
    EXPECT_TRUE(startsWith(refusal(baseWith(last_joint)), begin)) << last_joint;
  }
}

TEST(MobileModel, IsDetectedByTheNameOfTheRobot) {
  FakeRobot fake(10);
  fake.script([](FakeRobot::Script& s) { s.urdf.assign(kBase.begin(), kBase.end()); });
  const auto robot = connect(fake);
  EXPECT_TRUE(robot->isMobileRobot());
  EXPECT_NO_THROW(MobileModel(robot->getRobotModel()));
  EXPECT_TRUE(startsWith(textOf<franka::ModelException>([&] { robot->loadModel(); }),
                         "libfranka: This robot is a mobile base, not an arm."));
  FakeRobot panda(5);
  EXPECT_FALSE(connect(panda)->isMobileRobot());
  EXPECT_FALSE(franka::isMobileRobotUrdf(readData("fr3_hand.urdf")));
  EXPECT_FALSE(franka::isMobileRobotUrdf(""));
}

}  // namespace
}  // namespace franka_test
