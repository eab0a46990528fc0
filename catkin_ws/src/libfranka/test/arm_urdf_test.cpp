// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Reading arms from URDF texts: accepted texts, and the sentences for errors.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <regex>
#include <sstream>
#include <utility>

#include "random_state.h"

namespace franka_test {
namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;
using franka_core::endEffectorFromUrdf;
using franka_core::nominalEndEffectorFromUrdf;
using franka_core::Payload;

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) {
    throw std::logic_error("the test's URDF has no " + what);
  }
  return text.replace(at, what.size(), with);
}

std::string withoutInertial(const std::string& urdf, const std::string& link) {
  const std::size_t begin = urdf.find("<link name=\"" + link + "\">");
  const std::size_t from = urdf.find("<inertial>", begin);
  const std::size_t to = urdf.find("</inertial>", from) + std::string("</inertial>").size();
  return urdf.substr(0, from) + urdf.substr(to);
}

template <typename Action>
std::string refusalOf(Action action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no exception";
}

std::string armRefusal(const std::string& urdf, const std::string& arm_id = "") {
  return refusalOf([&] { ArmModel::fromUrdf(urdf, arm_id); });
}

void expectContains(const std::string& text, const std::string& part) {
  EXPECT_NE(std::string::npos, text.find(part)) << text;
}

const std::string& panda() {
  static const std::string text = readData("panda_hand.urdf");
  return text;
}

// Two arms in one description, the second a copy with another name and pose.
std::string twoArms() {
  const std::string second = std::regex_replace(panda(), std::regex("panda_|world"), "right_arm_");
  const auto bodyOf = [](const std::string& urdf) {
    const std::size_t from = urdf.find('>', urdf.find("<robot")) + 1;
    return urdf.substr(from, urdf.rfind("</robot>") - from);
  };
  return "<robot name=\"two\"><link name=\"table\"/>" + bodyOf(panda()) + bodyOf(second) +
         "<joint name=\"a\" type=\"fixed\"><parent link=\"table\"/><child link=\"world\"/>"
         "<origin xyz=\"0 1 0\"/></joint>"
         "<joint name=\"b\" type=\"fixed\"><parent link=\"table\"/><child link=\"right_arm_\"/>"
         "<origin xyz=\"0 -1 0\"/></joint></robot>";
}

TEST(FromUrdf, FindsASingleArmAndSelectsOneOfTwo) {
  const ArmModel one = ArmModel::fromUrdf(panda());
  const ArmModel right = ArmModel::fromUrdf(twoArms(), "right_arm");
  const std::array<double, 7> q{0.1, -0.2, 0.3, -1.4, 0.5, 1.6, 0.7};
  EXPECT_EQ(one.pose(ArmFrame::kFlange, q), right.pose(ArmFrame::kFlange, q));
  EXPECT_EQ(one.mass(q, {}), right.mass(q, {}));
}

TEST(FromUrdf, ReadsAnyPrefixIncludingNone) {
  const std::string bare = std::regex_replace(panda(), std::regex("panda_"), "");
  const std::string other = std::regex_replace(panda(), std::regex("panda_"), "arm-7_b_");
  EXPECT_EQ(0.735522, ArmModel::fromUrdf(bare).links()[6].mass);
  EXPECT_EQ(0.735522, ArmModel::fromUrdf(other, "arm-7_b").links()[6].mass);
}

TEST(FromUrdf, ExcludesTheHand) {
  const std::string heavy = replaced(panda(), "mass value=\"0.73\"", "mass value=\"73\"");
  EXPECT_EQ(ArmModel::fromUrdf(panda()).mass({}, {}), ArmModel::fromUrdf(heavy).mass({}, {}));
  EXPECT_GT(endEffectorFromUrdf(heavy).mass, 73.0);
}

// The same body, with its inertia in axes rotated by a quarter about z.
TEST(FromUrdf, RotatesInertiasGivenInOtherAxes) {
  const std::string turned = replaced(
      replaced(panda(), "<origin rpy=\"0 0 0\" xyz=\"0.010517 -0.004252 0.061597\" />",
               "<origin rpy=\"0 0 1.5707963267948966\" xyz=\"0.010517 -0.004252 0.061597\" />"),
      "ixx=\"0.012516\" ixy=\"-0.000428\" ixz=\"-0.001196\" iyy=\"0.010027\" iyz=\"-0.000741\"",
      "ixx=\"0.010027\" ixy=\"0.000428\" ixz=\"-0.000741\" iyy=\"0.012516\" iyz=\"0.001196\"");
  const auto expected = ArmModel::fromUrdf(panda()).links()[6];
  const auto link = ArmModel::fromUrdf(turned).links()[6];
  EXPECT_EQ(expected.com, link.com);
  for (std::size_t i = 0; i < 9; i++) {
    EXPECT_NEAR(expected.inertia[i], link.inertia[i], 1e-17);
  }
}

TEST(FromUrdf, IncludesBodiesFixedToALink) {
  const std::string camera = replaced(
      panda(), "</robot>",
      "<link name=\"camera\"><inertial><mass value=\"0.5\"/><origin xyz=\"0 0 0.1\"/>"
      "<inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\"/></inertial></link>"
      "<joint name=\"camera_joint\" type=\"fixed\"><parent link=\"panda_link5\"/>"
      "<child link=\"camera\"/><origin xyz=\"0.2 0 0\"/></joint></robot>");
  const auto plain = ArmModel::fromUrdf(panda()).links()[4];
  const auto link = ArmModel::fromUrdf(camera).links()[4];
  EXPECT_DOUBLE_EQ(plain.mass + 0.5, link.mass);
  EXPECT_NEAR((plain.mass * plain.com[0] + 0.5 * 0.2) / link.mass, link.com[0], 1e-16);
  EXPECT_NEAR((plain.mass * plain.com[2] + 0.5 * 0.1) / link.mass, link.com[2], 1e-16);
}

TEST(FromUrdf, ReportsErrorsWithTheirCause) {
  expectContains(armRefusal(""), "cannot be read as a robot description");
  expectContains(armRefusal("<robot"), "cannot be read as a robot description");
  expectContains(armRefusal("<robot name=\"r\"><link name=\"base\"/></robot>"),
                 "no chain of links <arm_id>_link0 to <arm_id>_link8");
  expectContains(armRefusal(panda(), "fr3"), "Arms found: 'panda'");
  expectContains(armRefusal(twoArms()), "several arms: 'panda', 'right_arm'");
  expectContains(armRefusal(withoutInertial(panda(), "panda_link4")),
                 "link 'panda_link4' has no inertial");
  expectContains(armRefusal(replaced(panda(), "mass value=\"3.587895\"", "mass value=\"0\"")),
                 "the mass of link 'panda_link4' must be greater than 0 kg");
  expectContains(armRefusal(replaced(panda(), "<axis xyz=\"0 0 1\" />", "<axis xyz=\"0 0 -1\" />")),
                 "joint 'panda_joint1' must turn about +z");
  expectContains(armRefusal(replaced(panda(), "<joint name=\"panda_joint3\" type=\"revolute\">",
                                     "<joint name=\"panda_joint3\" type=\"prismatic\">")),
                 "joint 'panda_joint3' must be of type revolute");
  expectContains(armRefusal(replaced(panda(), "<joint name=\"panda_joint8\" type=\"fixed\">",
                                     "<joint name=\"panda_joint8\" type=\"floating\">")),
                 "joint 'panda_joint8' between 'panda_link7' and 'panda_link8' must be fixed");
}

// Hand 0.73 kg and two fingers of 0.015 kg, hand turned by -45 degrees about the flange's z
// (decision 7).
TEST(EndEffectorFromUrdf, ComposesHandAndClosedFingers) {
  const Payload ee = endEffectorFromUrdf(panda(), "panda");
  EXPECT_NEAR(0.73 + 2 * 0.015, ee.mass, 1e-15);
  const Eigen::AngleAxisd turn(-M_PI / 4, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d hand = turn * Eigen::Vector3d(-0.01, 0.0, 0.03);
  const Eigen::Vector3d finger = turn * Eigen::Vector3d(0.0, 0.0, 0.0584);
  EXPECT_NEAR(hand.x() * 0.73 / 0.76, ee.com[0], 1e-12);
  EXPECT_NEAR(hand.y() * 0.73 / 0.76, ee.com[1], 1e-12);
  EXPECT_NEAR((0.73 * 0.03 + 0.03 * finger.z()) / 0.76, ee.com[2], 1e-15);
  const Eigen::Matrix3d inertia = Eigen::Map<const Eigen::Matrix3d>(ee.inertia.data());
  EXPECT_EQ(inertia, inertia.transpose());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues().minCoeff(), 0.0);
}

TEST(EndEffectorFromUrdf, IsDesksHandOnAnFr3) {
  const Payload ee = endEffectorFromUrdf(readData("fr3_hand.urdf"), "fr3");
  EXPECT_NEAR(0.73, ee.mass, 1e-15);
  const std::array<double, 3> com{-0.01, 0.0, 0.03};
  const std::array<double, 9> inertia{0.001, 0, 0, 0, 0.0025, 0, 0, 0, 0.0017};
  for (std::size_t i = 0; i < 3; i++) {
    EXPECT_NEAR(com[i], ee.com[i], 1e-15);
  }
  for (std::size_t i = 0; i < 9; i++) {
    EXPECT_NEAR(inertia[i], ee.inertia[i], 1e-15);
  }
}

TEST(EndEffectorFromUrdf, IsEmptyForABareArmAndRefusesAHandWithoutMass) {
  const std::string bare = std::regex_replace(
      panda(), std::regex("<parent link=\"panda_link8\" />"), "<parent link=\"panda_link0\" />");
  EXPECT_EQ(0.0, endEffectorFromUrdf(bare).mass);
  expectContains(refusalOf([] { endEffectorFromUrdf(withoutInertial(panda(), "panda_hand")); }),
                 "link 'panda_hand' has no inertial");
  expectContains(
      refusalOf([] { endEffectorFromUrdf(withoutInertial(panda(), "panda_rightfinger")); }),
      "link 'panda_rightfinger' has no inertial");
}

/// A mounted tool: the text of a URDF's fixed joints, and the pose that they have together.
class Mounting {
 public:
  /// @param parent the link that carries the first part
  Mounting(StateSource& source, std::string arm_id, std::string parent)
      : source_(source), arm_id_(std::move(arm_id)), parent_(std::move(parent)) {}

  /// Adds a joint from the last part to this one, with an origin of any size and direction.
  void add(const std::string& part) {
    const double x = source_.uniform(-0.3, 0.3), y = source_.uniform(-0.3, 0.3);
    const double z = source_.uniform(-0.3, 0.3), roll = source_.uniform(-3.1, 3.1);
    const double pitch = source_.uniform(-3.1, 3.1), yaw = source_.uniform(-3.1, 3.1);
    std::ostringstream joint;
    joint.precision(17);
    joint << "<joint name=\"" << part << "_joint\" type=\"fixed\"><parent link=\"" << arm_id_ << "_"
          << parent_ << "\"/><child link=\"" << arm_id_ << "_" << part << "\"/><origin xyz=\"" << x
          << " " << y << " " << z << "\" rpy=\"" << roll << " " << pitch << " " << yaw
          << "\"/></joint>";
    text_ += joint.str();
    pose_ = pose_ * Eigen::Translation3d(x, y, z) *
            Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
    parent_ = part;
  }

  void addPlate(const std::string& part) {
    text_ += "<link name=\"" + arm_id_ + "_" + part + "\"/>";
    add(part);
  }

  const std::string& text() const { return text_; }
  const Eigen::Isometry3d& pose() const { return pose_; }

 private:
  StateSource& source_;
  std::string arm_id_, parent_, text_;
  Eigen::Isometry3d pose_{Eigen::Isometry3d::Identity()};
};

std::string withoutJoint(const std::string& urdf, const std::string& joint) {
  const std::size_t from = urdf.find("<joint name=\"" + joint + "\"");
  const std::size_t to = urdf.find("</joint>", from) + std::string("</joint>").size();
  return urdf.substr(0, from) + urdf.substr(to);
}

class NominalEndEffectorFromUrdf : public ::testing::TestWithParam<Arm> {
 protected:
  /// The description with another name of the arm.
  std::string describe(const std::string& arm_id) const {
    return std::regex_replace(readData(GetParam().file),
                              std::regex(std::string(GetParam().arm_id) + "_"), arm_id + "_");
  }
};

TEST_P(NominalEndEffectorFromUrdf, IsWhereTransformsHaveTheToolCenterPointOfAnyMounting) {
  StateSource source(*GetParam().limits);
  for (int i = 0; i < 60; i++) {
    const std::string arm_id = i % 3 == 0 ? GetParam().arm_id : (i % 3 == 1 ? "left" : "arm-7_b");
    const std::string parent = i % 5 == 4 ? "link7" : "link8";
    Mounting mounting(source, arm_id, parent);
    for (int plate = 0; plate < i % 4; plate++) {
      mounting.addPlate("plate" + std::to_string(plate));
    }
    mounting.add("hand");
    mounting.add("hand_tcp");
    const std::string urdf =
        replaced(withoutJoint(withoutJoint(describe(arm_id), arm_id + "_hand_joint"),
                              arm_id + "_hand_tcp_joint"),
                 "</robot>", mounting.text() + "</robot>");
    const auto F_T_NE = nominalEndEffectorFromUrdf(urdf, arm_id);
    ASSERT_TRUE(F_T_NE.has_value());
    const ArmModel arm = ArmModel::fromUrdf(urdf, arm_id);
    const auto q = source.next().q;
    const auto carrier = arm.pose(parent == "link7" ? ArmFrame::kJoint7 : ArmFrame::kFlange, q);
    const Eigen::Matrix4d transform = pose(carrier) * mounting.pose().matrix();
    const auto O_T_EE = arm.pose(ArmFrame::kEndEffector, q, *F_T_NE);
    EXPECT_LT((transform - pose(O_T_EE)).cwiseAbs().maxCoeff(), 1e-12) << urdf;
  }
}

TEST_P(NominalEndEffectorFromUrdf, IsBetweenTheFingertipsOfAHandWithoutThisFrame) {
  const std::string id = GetParam().arm_id;
  const std::string urdf = describe(id);
  const std::string old = std::regex_replace(urdf, std::regex(id + "_hand_tcp\""), id + "_tip\"");
  const std::string tool =
      std::regex_replace(old, std::regex(id + "_(left|right)finger\""), id + "_$1pin\"");
  const auto with_frame = nominalEndEffectorFromUrdf(urdf, id);
  EXPECT_NEAR(0.1034, with_frame.value()[14], 1e-15);
  EXPECT_EQ(with_frame, nominalEndEffectorFromUrdf(old, id));
  EXPECT_FALSE(nominalEndEffectorFromUrdf(tool, id)) << "another tool with the hand's name";
}

INSTANTIATE_TEST_SUITE_P(Robots, NominalEndEffectorFromUrdf, ::testing::Values(kPanda, kFr3),
                         armName);

}  // namespace
}  // namespace franka_test
