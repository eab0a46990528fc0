// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The control unit's configuration from ROS parameters.

#include "arm_parameters.h"

#include <franka_sim/physics/world.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <ros_test/log_catcher.h>
#include <source_file.h>
#include <transform_sweep.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sentences.h"

namespace franka_sim_mujoco {
namespace {

std::string pandaUrdf() { return franka_test::readSource("franka_sim/robots/panda.urdf"); }

class ArmParameters : public testing::Test {
 protected:
  ArmParameters() : urdf_(pandaUrdf()) {
    franka_sim::RobotDescription description;
    description.name = "panda";
    description.urdf = urdf_;
    description.resolve = [](const std::string&) { return std::string(); };
    description.base.orientation = {std::cos(M_PI / 12.0), 0.0, std::sin(M_PI / 12.0), 0.0};
    world_.addRobot(description);
  }

  franka_sim::ControlUnitParameters read() const {
    RobotHandle robot;
    robot.world = const_cast<franka_sim::World*>(&world_);
    robot.name = "panda";
    robot.urdf = urdf_;
    return readArmParameters(node_, robot, SimulatedArm{"panda", "panda", {}, ""});
  }

  template <std::size_t N>
  void set(const std::string& name, const std::array<double, N>& values) {
    node_.setParam(name, std::vector<double>(values.begin(), values.end()));
  }

  std::string urdf_;
  franka_sim::World world_;
  ros::NodeHandle node_{"~/" +
                        std::string(testing::UnitTest::GetInstance()->current_test_info()->name())};
};

TEST_F(ArmParameters, AgreeWithEveryOtherInputOnRoundedMatrices) {
  std::array<double, 16> frame = franka_core::kIdentityTransform;
  frame[12] = 0.01;
  frame[14] = 0.1;
  for (const std::string name : {"F_T_NE", "NE_T_EE", "EE_T_K"}) {
    for (const franka_test::PerturbedMatrix& perturbed : franka_test::perturbations(frame)) {
      set(name, perturbed.matrix);
      const std::string refusal = sentence([this] { read(); });
      EXPECT_EQ(perturbed.accepted, refusal.empty())
          << name << ", " << perturbed << ": " << refusal;
      EXPECT_TRUE(perturbed.accepted ||
                  (contains(refusal, name) && contains(refusal, "exactly 0 0 0 1")))
          << refusal;
    }
    node_.deleteParam(name);
  }
}

TEST_F(ArmParameters, HaveGravityInTheAxesOfABaseThatIsPitchedBy30Degrees) {
  const std::array<double, 3> gravity = read().gravity;
  EXPECT_NEAR(9.81 / 2.0, gravity[0], 1e-9);
  EXPECT_NEAR(0.0, gravity[1], 1e-9);
  EXPECT_NEAR(-9.81 * std::sqrt(0.75), gravity[2], 1e-9);
}

TEST_F(ArmParameters, MakeTypedRotationsExactWithAWarning) {
  for (const std::string name : {"NE_T_EE", "EE_T_K", "F_T_NE"}) {
    const ros_test::LogCatcher log;
    set(name,
        std::array<double, 16>{0.866, 0.5, 0, 0, -0.5, 0.866, 0, 0, 0, 0, 1, 0, 0, 0, 0.1, 1});
    const franka_sim::ControlUnitParameters parameters = read();
    EXPECT_TRUE(contains(log.text(ros::console::levels::Warn), name));
    const std::array<double, 16>& frame = name == "NE_T_EE"  ? parameters.NE_T_EE
                                          : name == "EE_T_K" ? parameters.EE_T_K
                                                             : parameters.F_T_NE;
    EXPECT_NEAR(std::sqrt(0.75), frame[0], 1e-4);
    EXPECT_NEAR(1.0, std::hypot(frame[0], frame[1]), 1e-15);
    set(name, std::array<double, 16>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.1, 0, 0, 0, 1});
    EXPECT_TRUE(contains(sentence([this] { read(); }), "row-major"));
    node_.deleteParam(name);
  }
}

TEST_F(ArmParameters, FollowTheDescribedToolUnlessOneReplacesItWithAWarning) {
  const std::string tcp = "xyz=\"0 0 0.1034\"";
  urdf_.replace(urdf_.find(tcp), tcp.size(), "xyz=\"0 0 0.2\"");
  const ros_test::LogCatcher log;
  const std::array<double, 16> described = read().F_T_NE;
  EXPECT_NEAR(0.2, described[14], 1e-15);
  EXPECT_EQ("", log.text(ros::console::levels::Warn));
  set("F_T_NE", franka_sim::kHandF_T_NE);
  EXPECT_EQ(0.1034, read().F_T_NE[14]);
  const std::string warning = log.text(ros::console::levels::Warn);
  EXPECT_TRUE(contains(warning, "96.6 mm") && contains(warning, "F_T_NE")) << warning;
}

TEST_F(ArmParameters, LowerThresholdsAboveTheUpperOnesAreTakenWithAWarning) {
  const std::array<double, 7> torques{31, 32, 33, 34, 35, 36, 37};
  const std::array<double, 6> forces{41, 42, 43, 44, 45, 46};
  set("collision_config/lower_torque_thresholds_nominal", torques);
  set("collision_config/lower_force_thresholds_acceleration", forces);
  const ros_test::LogCatcher log;
  const franka_sim::ControlUnitParameters parameters = read();
  EXPECT_EQ(torques, parameters.nominal.lower_torque);
  EXPECT_GT(torques[0], parameters.nominal.upper_torque[0]);
  EXPECT_EQ(forces, parameters.acceleration.lower_force);
  EXPECT_GT(forces[0], parameters.acceleration.upper_force[0]);
  for (const char* part :
       {"collision_config/*_nominal: The lower torque threshold 1 (31) is above the upper one "
        "(20): collisions begin before contacts.",
        "collision_config/*_acceleration: The lower torque threshold 1 (31) is above"}) {
    EXPECT_TRUE(contains(log.text(ros::console::levels::Warn), part)) << part << "\n" << log.text();
  }
}

TEST_F(ArmParameters, OfAnArmWhoseNameRosCannotHaveAreNotSet) {
  const std::array<double, 7> stiffness{1, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(stiffness, readJointStiffness(node_, "arm-1", stiffness));
  EXPECT_EQ("", gainsWithoutEffect(node_, "arm-1"));
  node_.setParam("motion_generators/position/gains/arm_joint2/p", 20.0);
  EXPECT_EQ(20.0, readJointStiffness(node_, "arm", stiffness)[1]);
}

TEST(ThresholdRemark, NamesTheFirstLowerThresholdAboveItsUpperOne) {
  franka_sim::CollisionThresholds thresholds;
  thresholds.lower_torque.fill(10.0);
  thresholds.upper_torque.fill(10.0);
  thresholds.lower_force.fill(20.0);
  thresholds.upper_force.fill(20.5);
  EXPECT_EQ("", thresholdRemark(thresholds));
  thresholds.lower_force[4] = 21.5;
  EXPECT_EQ(
      "The lower force threshold 5 (21.5) is above the upper one (20.5): collisions begin before "
      "contacts.",
      thresholdRemark(thresholds));
  thresholds.lower_torque[6] = 1e3;
  thresholds.lower_torque[2] = 10.25;
  EXPECT_EQ(
      "The lower torque threshold 3 (10.25) is above the upper one (10): collisions begin before "
      "contacts.",
      thresholdRemark(thresholds));
  EXPECT_EQ("", checkThresholds(thresholds));
}

}  // namespace
}  // namespace franka_sim_mujoco

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "arm_parameters_test");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
