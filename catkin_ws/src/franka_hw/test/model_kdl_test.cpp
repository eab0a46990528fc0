// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/arm_model.h>
#include <franka_hw/model_kdl.h>
#include <gtest/gtest.h>
#include <rt_guard/rt_guard.h>
#include <source_file.h>
#include <urdf/model.h>

#include <Eigen/Dense>
#include <cmath>
#include <kdl/chaindynparam.hpp>
#include <kdl/tree.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

namespace franka_hw {
namespace {

using Array3 = std::array<double, 3>;
using Array7 = std::array<double, 7>;
using Array9 = std::array<double, 9>;
using Array16 = std::array<double, 16>;

constexpr int kStates = 1000;

std::string readUrdf(const std::string& robot) {
  return franka_test::readSource("libfranka/test/data/" + robot + "_hand.urdf");
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t position = text.find(from);
  EXPECT_NE(std::string::npos, position) << from;
  for (; position != std::string::npos; position = text.find(from, position + to.size())) {
    text.replace(position, from.size(), to);
  }
  return text;
}

urdf::Model parsed(const std::string& text) {
  urdf::Model model;
  EXPECT_TRUE(model.initString(text));
  return model;
}

/// One state of the arm and its expected results.
struct Sample {
  Array7 q, dq;
  Array16 F_T_EE, EE_T_K;
  double mass;
  Array3 com, gravity;
  Array9 inertia;
};

class Samples {
 public:
  Sample next() {
    Sample sample;
    for (std::size_t i = 0; i < 7; ++i) {
      sample.q[i] = uniform(-M_PI, M_PI);
      sample.dq[i] = uniform(-2.6, 2.6);
    }
    sample.F_T_EE = transform();
    sample.EE_T_K = transform();
    sample.mass = uniform(0.01, 5.0);
    for (std::size_t i = 0; i < 3; ++i) {
      sample.com[i] = uniform(-0.2, 0.2);
      sample.gravity[i] = uniform(-12.0, 12.0);
    }
    Eigen::Matrix3d factor;
    for (int i = 0; i < 9; ++i) {
      factor.data()[i] = uniform(-0.1, 0.1);
    }
    Eigen::Map<Eigen::Matrix3d>(sample.inertia.data()) = factor * factor.transpose();
    return sample;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }

  Array16 transform() {
    Eigen::Quaterniond rotation(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    Eigen::Isometry3d result(rotation.normalized());
    result.translation() << uniform(-0.3, 0.3), uniform(-0.3, 0.3), uniform(-0.3, 0.3);
    Array16 values;
    Eigen::Map<Eigen::Matrix4d>(values.data()) = result.matrix();
    return values;
  }

  std::mt19937 generator_{20260};
};

template <std::size_t N>
double difference(const std::array<double, N>& left, const std::array<double, N>& right) {
  double largest = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    const double gap = std::abs(left[i] - right[i]);
    largest = gap <= largest ? largest : gap;  // keeps NaN
  }
  return largest;
}

class ModelKDLTest : public testing::TestWithParam<const char*> {
 protected:
  std::string robot = GetParam();
  std::string urdf_text = readUrdf(robot);
  ModelKDL model{parsed(urdf_text), robot + "_link0", robot + "_link8"};
  Samples samples;
};

TEST_P(ModelKDLTest, AgreesWithTheIndependentArmModel) {
  const franka_core::ArmModel other = franka_core::ArmModel::fromUrdf(urdf_text, robot);
  for (int n = 0; n < kStates; ++n) {
    const Sample s = samples.next();
    for (int f = 0; f <= static_cast<int>(franka::Frame::kStiffness); ++f) {
      const auto frame = static_cast<franka::Frame>(f);
      const auto arm_frame = static_cast<franka_core::ArmFrame>(f);
      ASSERT_LT(difference(model.pose(frame, s.q, s.F_T_EE, s.EE_T_K),
                           other.pose(arm_frame, s.q, s.F_T_EE, s.EE_T_K)),
                1e-12)
          << "frame " << f;
      ASSERT_LT(difference(model.zeroJacobian(frame, s.q, s.F_T_EE, s.EE_T_K),
                           other.zeroJacobian(arm_frame, s.q, s.F_T_EE, s.EE_T_K)),
                1e-12)
          << "frame " << f;
      ASSERT_LT(difference(model.bodyJacobian(frame, s.q, s.F_T_EE, s.EE_T_K),
                           other.bodyJacobian(arm_frame, s.q, s.F_T_EE, s.EE_T_K)),
                1e-12)
          << "frame " << f;
    }
    const franka_core::Payload payload{s.mass, s.com, s.inertia};
    ASSERT_LT(difference(model.mass(s.q, s.inertia, s.mass, s.com), other.mass(s.q, payload)),
              1e-11);
    ASSERT_LT(difference(model.coriolis(s.q, s.dq, s.inertia, s.mass, s.com),
                         other.coriolis(s.q, s.dq, payload)),
              1e-11);
    ASSERT_LT(difference(model.gravity(s.q, s.mass, s.com, s.gravity),
                         other.gravity(s.q, payload, s.gravity)),
              1e-11);
    // A payload belongs to its call only.
    ASSERT_LT(difference(model.coriolis(s.q, s.dq, {}, 0.0, {}), other.coriolis(s.q, s.dq, {})),
              1e-11);
    model.coriolis(s.q, s.dq, s.inertia, s.mass, s.com);
    ASSERT_LT(difference(model.mass(s.q, {}, 0.0, {}), other.mass(s.q, {})), 1e-11);
    model.coriolis(s.q, s.dq, s.inertia, s.mass, s.com);
    ASSERT_LT(difference(model.gravity(s.q, 0.0, {}, s.gravity), other.gravity(s.q, {}, s.gravity)),
              1e-11);
  }
}

TEST_P(ModelKDLTest, AgreesWithKdlSolversOfAnAugmentedChain) {
  KDL::Tree tree;
  ASSERT_TRUE(kdl_parser::treeFromUrdfModel(parsed(urdf_text), tree));
  for (int n = 0; n < 50; ++n) {
    const Sample s = samples.next();
    KDL::Chain chain;
    ASSERT_TRUE(tree.getChain(robot + "_link0", robot + "_link8", chain));
    ModelKDL::augmentFrame("load", s.com, s.mass, s.inertia, chain);
    KDL::ChainDynParam solver(chain, KDL::Vector(s.gravity[0], s.gravity[1], s.gravity[2]));
    KDL::JntArray q(7);
    KDL::JntArray torques(7);
    q.data = Eigen::Map<const Eigen::Matrix<double, 7, 1>>(s.q.data());
    ASSERT_EQ(0, solver.JntToGravity(q, torques));
    const Array7 gravity = model.gravity(s.q, s.mass, s.com, s.gravity);
    KDL::JntSpaceInertiaMatrix inertia(7);
    ASSERT_EQ(0, solver.JntToMass(q, inertia));
    const std::array<double, 49> mass = model.mass(s.q, s.inertia, s.mass, s.com);
    for (int i = 0; i < 7; ++i) {
      ASSERT_NEAR(torques(i), gravity[i], 1e-11);
      for (int j = 0; j < 7; ++j) {
        ASSERT_NEAR(inertia(i, j), mass[7 * j + i], 1e-11);
      }
    }
  }
}

TEST_P(ModelKDLTest, ReadsTurnedInertialFrames) {
  // The same numbers in turned frames are different inertias; both readers must read the same
  // inertias.
  const std::string x = robot == "panda" ? "0.027518" : "0.0407015686";  // of link 3
  const std::string turned = replaced(urdf_text, "<origin rpy=\"0 0 0\" xyz=\"" + x,
                                      "<origin rpy=\"0.3 -0.2 1.1\" xyz=\"" + x);
  const ModelKDL turned_model(parsed(turned), robot + "_link0", robot + "_link8");
  const franka_core::ArmModel other = franka_core::ArmModel::fromUrdf(turned, robot);
  const Sample s = samples.next();
  const franka_core::Payload payload{s.mass, s.com, s.inertia};
  EXPECT_LT(difference(turned_model.mass(s.q, s.inertia, s.mass, s.com), other.mass(s.q, payload)),
            1e-11);
  EXPECT_GT(difference(turned_model.mass(s.q, s.inertia, s.mass, s.com),
                       model.mass(s.q, s.inertia, s.mass, s.com)),
            1e-3);
}

TEST_P(ModelKDLTest, NeitherAllocatesNorLocks) {
  const ModelKDL watched(parsed(urdf_text), robot + "_link0", robot + "_link8", 1e-4);
  double sum = 0.0;
  rt_guard::Scope scope;
  for (int n = 0; n < kStates; ++n) {
    const Sample s = samples.next();
    for (int f = 0; f <= static_cast<int>(franka::Frame::kStiffness); ++f) {
      const auto frame = static_cast<franka::Frame>(f);
      sum += watched.pose(frame, s.q, s.F_T_EE, s.EE_T_K)[0];
      sum += watched.zeroJacobian(frame, s.q, s.F_T_EE, s.EE_T_K)[0];
      sum += watched.bodyJacobian(frame, s.q, s.F_T_EE, s.EE_T_K)[0];
    }
    sum += watched.mass(s.q, s.inertia, s.mass, s.com)[0];
    sum += watched.coriolis(s.q, s.dq, s.inertia, s.mass, s.com)[0];
    sum += watched.gravity(s.q, s.mass, s.com, s.gravity)[0];
  }
  EXPECT_EQ(0U, scope.allocations());
  EXPECT_EQ(0U, scope.locks());
  EXPECT_TRUE(std::isfinite(sum));
}

TEST_P(ModelKDLTest, WarnsOfSingularitiesAtAModestPace) {
  const Array7 stretched{};
  const Array7 ready{{0, -M_PI_4, 0, -3 * M_PI_4, 0, M_PI_2, M_PI_4}};
  const Array16 identity = franka_core::kIdentityTransform;
  const auto warnsAt = [&](const Array7& q, franka::Frame frame, double threshold) {
    ModelKDL watched(parsed(urdf_text), robot + "_link0", robot + "_link8", threshold);
    watched.zeroJacobian(frame, q, identity, identity);
    return watched.takeSingularityWarning();
  };
  for (const franka::Frame frame :
       {franka::Frame::kFlange, franka::Frame::kEndEffector, franka::Frame::kStiffness}) {
    EXPECT_TRUE(warnsAt(stretched, frame, 1e-4));
    EXPECT_FALSE(warnsAt(ready, frame, 1e-4));
  }
  EXPECT_FALSE(warnsAt(stretched, franka::Frame::kJoint4, 1e-4)) << "always singular, so no news";
  EXPECT_FALSE(warnsAt(stretched, franka::Frame::kFlange, -1.0)) << "switched off";

  ModelKDL watched(parsed(urdf_text), robot + "_link0", robot + "_link8", 1e-4);
  watched.bodyJacobian(franka::Frame::kFlange, stretched, identity, identity);
  watched.bodyJacobian(franka::Frame::kFlange, stretched, identity, identity);
  EXPECT_TRUE(watched.takeSingularityWarning());
  EXPECT_FALSE(watched.takeSingularityWarning()) << "one warning was taken twice";
}

INSTANTIATE_TEST_SUITE_P(Robots, ModelKDLTest, testing::Values("panda", "fr3"),
                         [](const auto& info) { return std::string(info.param); });

/// The message for a refused robot description.
std::string refusal(const std::string& urdf_text, const std::string& root, const std::string& tip) {
  try {
    const ModelKDL model(parsed(urdf_text), root, tip);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ModelKDLRefusal, NamesTheLinkThatIsMissing) {
  const std::string text = readUrdf("panda");
  EXPECT_NE(std::string::npos,
            refusal(text, "fr3_link0", "fr3_link8").find("has no link 'fr3_link0'"));
  EXPECT_NE(std::string::npos, refusal(text, "panda_link0", "tool").find("has no link 'tool'"));
}

TEST(ModelKDLRefusal, NamesAChainThatIsNotAnArm) {
  const std::string text = readUrdf("panda");
  EXPECT_NE(std::string::npos,
            refusal(text, "panda_link0", "panda_link7").find("7 moving and 0 fixed joints"));
  EXPECT_NE(std::string::npos,
            refusal(text, "panda_link2", "panda_link8").find("5 moving and 1 fixed joints"));
  EXPECT_NE(std::string::npos,
            refusal(text, "panda_link0", "panda_leftfinger").find("8 moving and 2 fixed joints"));
  EXPECT_NE(std::string::npos,
            refusal(text, "panda_leftfinger", "panda_rightfinger").find("cannot be used"));
}

TEST(ModelKDLRefusal, NamesTheLinkWithoutMass) {
  const std::string text =
      replaced(readUrdf("panda"), "<mass value=\"3.228604\"", "<mass value=\"0\"");
  EXPECT_NE(std::string::npos,
            refusal(text, "panda_link0", "panda_link8").find("link 'panda_link3' has no mass"));
}

}  // namespace
}  // namespace franka_hw

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
