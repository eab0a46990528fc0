// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <joint_limits_interface/joint_limits_rosparam.h>
#include <joint_limits_interface/joint_limits_urdf.h>
#include <ros/node_handle.h>

#include <string>

using namespace joint_limits_interface;

namespace {

/// Limits that no reader produces: unchanged values are detected.
JointLimits marked() {
  JointLimits limits;
  limits.min_position = limits.max_position = limits.max_velocity = 77.0;
  limits.max_acceleration = limits.max_jerk = limits.max_effort = 77.0;
  limits.has_acceleration_limits = limits.has_jerk_limits = true;
  return limits;
}

urdf::JointConstSharedPtr joint(decltype(urdf::Joint::type) type, bool with_limits = true,
                                bool with_safety = false) {
  auto made = std::make_shared<urdf::Joint>();
  made->type = type;
  if (with_limits) {
    made->limits = std::make_shared<urdf::JointLimits>();
    made->limits->lower = -1.0;
    made->limits->upper = 2.0;
    made->limits->velocity = 3.0;
    made->limits->effort = 4.0;
  }
  if (with_safety) {
    made->safety = std::make_shared<urdf::JointSafety>();
    made->safety->soft_lower_limit = -0.5;
    made->safety->soft_upper_limit = 1.5;
    made->safety->k_position = 5.0;
    made->safety->k_velocity = 6.0;
  }
  return made;
}

class ParamLimits : public testing::Test {
 protected:
  // Not in main: death tests fork, and ROS starts threads.
  static void SetUpTestSuite() { static const ros::NodeHandle keeps_ros_alive; }

  ~ParamLimits() override { nh_.deleteParam("joint_limits"); }

  template <class T>
  void set(const std::string& name, const T& value) {
    nh_.setParam("joint_limits/j/" + name, value);
  }

  ros::NodeHandle nh_{"limits_test"};
};

}  // namespace

TEST(UrdfLimits, MissingLimitsReturnFalse) {
  JointLimits limits = marked();
  EXPECT_FALSE(getJointLimits(urdf::JointConstSharedPtr(), limits));
  EXPECT_FALSE(getJointLimits(joint(urdf::Joint::REVOLUTE, false), limits));
  EXPECT_EQ(77.0, limits.max_velocity);
  EXPECT_FALSE(limits.has_velocity_limits);
  SoftJointLimits soft;
  EXPECT_FALSE(getSoftJointLimits(urdf::JointConstSharedPtr(), soft));
  EXPECT_FALSE(getSoftJointLimits(joint(urdf::Joint::REVOLUTE), soft));
}

TEST(UrdfLimits, ReadsJointsWithStops) {
  for (const auto type : {urdf::Joint::REVOLUTE, urdf::Joint::PRISMATIC}) {
    JointLimits limits = marked();
    ASSERT_TRUE(getJointLimits(joint(type), limits));
    EXPECT_TRUE(limits.has_position_limits);
    EXPECT_EQ(-1.0, limits.min_position);
    EXPECT_EQ(2.0, limits.max_position);
    EXPECT_TRUE(limits.has_velocity_limits);
    EXPECT_EQ(3.0, limits.max_velocity);
    EXPECT_TRUE(limits.has_effort_limits);
    EXPECT_EQ(4.0, limits.max_effort);
    EXPECT_FALSE(limits.angle_wraparound);
    EXPECT_FALSE(limits.has_acceleration_limits);
    EXPECT_TRUE(limits.has_jerk_limits) << "URDF says nothing about jerk";
    EXPECT_EQ(77.0, limits.max_jerk);
  }
}

TEST(UrdfLimits, ReadsContinuousJoints) {
  JointLimits limits = marked();
  limits.has_position_limits = true;
  ASSERT_TRUE(getJointLimits(joint(urdf::Joint::CONTINUOUS), limits));
  EXPECT_FALSE(limits.has_position_limits);
  EXPECT_TRUE(limits.angle_wraparound);
  EXPECT_EQ(77.0, limits.min_position);
  EXPECT_TRUE(limits.has_velocity_limits);
}

TEST(UrdfLimits, ReadsTheSafetyController) {
  SoftJointLimits soft;
  ASSERT_TRUE(getSoftJointLimits(joint(urdf::Joint::REVOLUTE, true, true), soft));
  EXPECT_EQ(-0.5, soft.min_position);
  EXPECT_EQ(1.5, soft.max_position);
  EXPECT_EQ(5.0, soft.k_position);
  EXPECT_EQ(6.0, soft.k_velocity);
}

TEST_F(ParamLimits, MissingLimitsReturnFalse) {
  JointLimits limits = marked();
  SoftJointLimits soft;
  EXPECT_FALSE(getJointLimits("j", nh_, limits));
  EXPECT_FALSE(getSoftJointLimits("j", nh_, soft));
  EXPECT_FALSE(getJointLimits("no name!", nh_, limits));
  EXPECT_FALSE(getSoftJointLimits("no name!", nh_, soft));
  EXPECT_EQ(77.0, limits.max_velocity);
}

TEST_F(ParamLimits, ReadsAllKinds) {
  for (const char* kind : {"position", "velocity", "acceleration", "jerk", "effort"}) {
    set("has_" + std::string(kind) + "_limits", true);
  }
  set("min_position", -1.5);
  set("max_position", 2);  // an integer is a number
  set("max_velocity", 3.5);
  set("max_acceleration", 4.5);
  set("max_jerk", 5.5);
  set("max_effort", 6.5);
  set("angle_wraparound", true);  // not read: the joint has ends
  JointLimits limits;
  ASSERT_TRUE(getJointLimits("j", nh_, limits));
  EXPECT_TRUE(limits.has_position_limits && limits.has_velocity_limits &&
              limits.has_acceleration_limits && limits.has_jerk_limits && limits.has_effort_limits);
  EXPECT_EQ(-1.5, limits.min_position);
  EXPECT_EQ(2.0, limits.max_position);
  EXPECT_EQ(3.5, limits.max_velocity);
  EXPECT_EQ(4.5, limits.max_acceleration);
  EXPECT_EQ(5.5, limits.max_jerk);
  EXPECT_EQ(6.5, limits.max_effort);
  EXPECT_FALSE(limits.angle_wraparound);
}

TEST_F(ParamLimits, OverrideAUrdfInPart) {
  set("has_velocity_limits", true);
  set("max_velocity", 1.0);
  set("has_effort_limits", false);
  JointLimits limits;
  ASSERT_TRUE(getJointLimits(joint(urdf::Joint::REVOLUTE), limits));
  ASSERT_TRUE(getJointLimits("j", nh_, limits));
  EXPECT_EQ(1.0, limits.max_velocity);
  EXPECT_TRUE(limits.has_velocity_limits);
  EXPECT_FALSE(limits.has_effort_limits);
  EXPECT_TRUE(limits.has_position_limits);
  EXPECT_EQ(-1.0, limits.min_position);
}

TEST_F(ParamLimits, IncompleteLimitsHaveNoEffect) {
  set("max_velocity", 1.0);  // no flag
  set("has_position_limits", true);
  set("min_position", -1.0);  // no max_position
  set("has_jerk_limits", true);
  set("max_jerk", "fast");
  set("has_effort_limits", "yes, please");
  set("max_effort", 1.0);
  JointLimits limits = marked();
  ASSERT_TRUE(getJointLimits("j", nh_, limits));
  EXPECT_EQ(77.0, limits.max_velocity);
  EXPECT_FALSE(limits.has_velocity_limits);
  EXPECT_EQ(77.0, limits.min_position);
  EXPECT_FALSE(limits.has_position_limits);
  EXPECT_EQ(77.0, limits.max_jerk);
  EXPECT_TRUE(limits.has_jerk_limits) << "as it was";
  EXPECT_FALSE(limits.has_effort_limits);
}

TEST_F(ParamLimits, OnlyJointsWithoutPositionLimitsWrapAround) {
  JointLimits limits;
  set("angle_wraparound", true);
  ASSERT_TRUE(getJointLimits("j", nh_, limits));
  EXPECT_FALSE(limits.angle_wraparound);
  set("has_position_limits", false);
  ASSERT_TRUE(getJointLimits("j", nh_, limits));
  EXPECT_TRUE(limits.angle_wraparound);
}

TEST_F(ParamLimits, SoftLimitsNeedAllValues) {
  SoftJointLimits soft;
  set("has_soft_limits", true);
  set("k_position", 1.0);
  set("k_velocity", 2.0);
  set("soft_lower_limit", -3.0);
  EXPECT_FALSE(getSoftJointLimits("j", nh_, soft));
  EXPECT_EQ(0.0, soft.k_position);
  set("soft_upper_limit", 4.0);
  ASSERT_TRUE(getSoftJointLimits("j", nh_, soft));
  EXPECT_EQ(1.0, soft.k_position);
  EXPECT_EQ(2.0, soft.k_velocity);
  EXPECT_EQ(-3.0, soft.min_position);
  EXPECT_EQ(4.0, soft.max_position);

  SoftJointLimits untouched;
  set("has_soft_limits", false);
  EXPECT_FALSE(getSoftJointLimits("j", nh_, untouched));
  EXPECT_EQ(0.0, untouched.k_position);
}
