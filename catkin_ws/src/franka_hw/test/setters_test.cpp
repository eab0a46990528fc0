// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka_hw/setters.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace franka_hw {
namespace {

/// Records its calls.
class Recorder {
 public:
  using Joints = std::array<double, 7>;
  using Forces = std::array<double, 6>;
  using Matrix = std::array<double, 16>;

  void setJointImpedance(const Joints& stiffness) { record("setJointImpedance", stiffness); }
  void setCartesianImpedance(const Forces& stiffness) {
    record("setCartesianImpedance", stiffness);
  }
  void setEE(const Matrix& NE_T_EE) { record("setEE", NE_T_EE); }
  void setK(const Matrix& EE_T_K) { record("setK", EE_T_K); }
  void setLoad(double mass, const std::array<double, 3>& center,
               const std::array<double, 9>& inertia) {
    record("setLoad", std::array<double, 1>{mass}, center, inertia);
  }
  template <typename... Thresholds>
  void setCollisionBehavior(const Thresholds&... thresholds) {
    record("setCollisionBehavior", thresholds...);
  }

  std::string called;
  std::vector<double> firsts;  ///< the first number of each argument

 private:
  template <typename... Arguments>
  void record(const std::string& name, const Arguments&... arguments) {
    called = name;
    firsts = {arguments.front()...};
  }
};

template <typename Request>
Recorder recordOf(const Request& request) {
  Recorder recorder;
  configure(recorder, request);
  return recorder;
}

TEST(Setters, CallTheSetterOfTheirName) {
  EXPECT_EQ("setJointImpedance", recordOf(franka_msgs::SetJointImpedance::Request()).called);
  EXPECT_EQ("setCartesianImpedance",
            recordOf(franka_msgs::SetCartesianImpedance::Request()).called);
  EXPECT_EQ("setEE", recordOf(franka_msgs::SetEEFrame::Request()).called);
  EXPECT_EQ("setK", recordOf(franka_msgs::SetKFrame::Request()).called);
}

TEST(CheckedRequest, HasTheExactRotationOfATypedOne) {
  franka_msgs::SetEEFrame::Request end_effector;
  end_effector.NE_T_EE = {0.707, 0.707, 0, 0, -0.707, 0.707, 0, 0, 0, 0, 1, 0, 0, 0, 0.1, 1};
  EXPECT_NEAR(M_SQRT1_2, checkedRequest(end_effector).NE_T_EE[0], 1e-15);
  franka_msgs::SetKFrame::Request stiffness;
  stiffness.EE_T_K = end_effector.NE_T_EE;
  EXPECT_NEAR(M_SQRT1_2, checkedRequest(stiffness).EE_T_K[0], 1e-15);
}

TEST(CheckedRequest, RefusesMatricesThatAreNotTransforms) {
  EXPECT_THROW(checkedRequest(franka_msgs::SetEEFrame::Request()), franka::CommandException);
  EXPECT_THROW(checkedRequest(franka_msgs::SetKFrame::Request()), franka::CommandException);
  EXPECT_NO_THROW(checkedRequest(franka_msgs::SetLoad::Request()));
}

TEST(Setters, PassStiffnessesOn) {
  franka_msgs::SetJointImpedance::Request joints;
  joints.joint_stiffness.fill(1.0);
  EXPECT_EQ((std::vector<double>{1.0}), recordOf(joints).firsts);
  franka_msgs::SetCartesianImpedance::Request cartesian;
  cartesian.cartesian_stiffness.fill(2.0);
  EXPECT_EQ((std::vector<double>{2.0}), recordOf(cartesian).firsts);
}

TEST(Setters, PassTheLoadOn) {
  franka_msgs::SetLoad::Request request;
  request.mass = 1.0;
  request.F_x_center_load.fill(2.0);
  request.load_inertia.fill(3.0);
  EXPECT_EQ((std::vector<double>{1.0, 2.0, 3.0}), recordOf(request).firsts);
}

TEST(Setters, PassNominalThresholdsOnInTheOrderOfTheRobot) {
  franka_msgs::SetForceTorqueCollisionBehavior::Request request;
  request.lower_torque_thresholds_nominal.fill(1.0);
  request.upper_torque_thresholds_nominal.fill(2.0);
  request.lower_force_thresholds_nominal.fill(3.0);
  request.upper_force_thresholds_nominal.fill(4.0);
  EXPECT_EQ((std::vector<double>{1.0, 2.0, 3.0, 4.0}), recordOf(request).firsts);
}

TEST(Setters, PassAllThresholdsOnInTheOrderOfTheRobot) {
  franka_msgs::SetFullCollisionBehavior::Request request;
  request.lower_torque_thresholds_acceleration.fill(1.0);
  request.upper_torque_thresholds_acceleration.fill(2.0);
  request.lower_torque_thresholds_nominal.fill(3.0);
  request.upper_torque_thresholds_nominal.fill(4.0);
  request.lower_force_thresholds_acceleration.fill(5.0);
  request.upper_force_thresholds_acceleration.fill(6.0);
  request.lower_force_thresholds_nominal.fill(7.0);
  request.upper_force_thresholds_nominal.fill(8.0);
  EXPECT_EQ((std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0}),
            recordOf(request).firsts);
}

}  // namespace
}  // namespace franka_hw
