// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The control unit on the arm simulated by MuJoCo: rest, free motion, pushes, a load that is not
// configured.
#include <franka_core/arm_model.h>
#include <franka_core/numbers.h>
#include <franka_core/rotations.h>
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world_properties.h>
#include <franka_sim/robot/control_unit.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "../physics/test_support.h"

namespace franka_sim {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix4 = Eigen::Matrix4d;
using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Jacobian = Eigen::Matrix<double, 6, 7>;
using Array7 = std::array<double, 7>;

Eigen::Map<const Vector7> vector(const Array7& array) {
  return Eigen::Map<const Vector7>(array.data());
}

Array7 array(const Vector7& vector) {
  Array7 result;
  Vector7::Map(result.data()) = vector;
  return result;
}

class ArmInWorld : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override { build(0.0); }

  // `extra_hand_mass`: difference to the hand's mass in the control unit [kg].
  void build(double extra_hand_mass) {
    const std::string id = GetParam();
    std::string urdf = test::urdfOf(id);
    model_ = std::make_unique<franka_core::ArmModel>(franka_core::ArmModel::fromUrdf(urdf, id));
    ControlUnitParameters parameters{*model_};
    parameters.F_T_NE = kHandF_T_NE;
    parameters.end_effector = franka_core::endEffectorFromUrdf(urdf, id);
    // The wrench is tested, so no collision may be raised.
    parameters.nominal.upper_force.fill(1e3);
    parameters.nominal.upper_torque.fill(1e3);
    parameters.acceleration = parameters.nominal;
    if (extra_hand_mass > 0) {
      addMass(urdf, id + "_hand", extra_hand_mass);
    }
    world_ = std::make_unique<World>();
    RobotDescription robot;
    robot.name = id;
    robot.urdf = urdf;
    robot.resolve = [](const std::string&) { return std::string(); };
    setInitialPositions(kReadyPose, id, robot);
    applyPhysics(RobotPhysics{}, id, robot);
    world_->addRobot(robot);
    arm_ = &world_->arm(id, id);
    unit_ = std::make_unique<ControlUnit>(parameters);
    hand_ = id + "_hand";
  }

  static void addMass(std::string& urdf, const std::string& link, double extra) {
    const auto begin = urdf.find("<link name=\"" + link + "\"");
    const auto value = urdf.find("<mass value=\"", begin) + 13;
    const auto end = urdf.find('"', value);
    const double mass = franka_core::readNumber(urdf.substr(value, end - value)).value();
    urdf.replace(value, end - value, franka_core::numberText(mass + extra));
  }

  // One millisecond under external torque control.
  template <typename Law>
  void tick(Law&& law) {
    const auto& state = unit_->observe(arm_->measure());
    franka_core::RobotCommand command;
    command.message_id = state.message_id;
    command.tau_J_d = law(state);
    arm_->setBrakes(unit_->status().brakes_closed);
    arm_->applyTorques(unit_->actuate(&command));
    world_->step();
  }

  void idleTick() {
    unit_->observe(arm_->measure());
    arm_->applyTorques(unit_->actuate(nullptr));
    world_->step();
  }

  Jacobian jacobian(const franka_core::RobotState& state) const {
    const auto columns =
        model_->zeroJacobian(franka_core::ArmFrame::kEndEffector, state.q, state.F_T_EE);
    return Jacobian::Map(columns.data());
  }

  franka_core::Payload total(const franka_core::RobotState& state) const {
    return {state.m_total, state.F_x_Ctotal, state.I_total};
  }

  // Holds the pose of `target` like the example's impedance controller, with a stiff null space.
  Array7 impedance(const franka_core::RobotState& state, const Matrix4& target,
                   const Vector7& posture) const {
    const Matrix4 pose = Matrix4::Map(state.O_T_EE.data());
    const Jacobian J = jacobian(state);
    const Vector6 error = franka_core::twistBetween(target, pose, 1.0);
    Vector6 stiffness;
    stiffness << 600, 600, 600, 50, 50, 50;
    const Vector7 dq = vector(state.dq);
    const Vector6 wrench =
        -stiffness.cwiseProduct(error) - 2 * stiffness.cwiseSqrt().cwiseProduct(J * dq);
    const Eigen::Matrix<double, 7, 6> pinv = J.transpose() * (J * J.transpose()).inverse();
    const Matrix7 null_space = Matrix7::Identity() - J.transpose() * pinv.transpose();
    const auto coriolis = model_->coriolis(state.q, state.dq, total(state));
    return array(J.transpose() * wrench + null_space * (20 * (posture - vector(state.q)) - 9 * dq) +
                 vector(coriolis));
  }

  // Pushes with a force and a torque (axes of O) at the end effector and returns the wrenches in
  // steady state.
  std::pair<Vector6, Vector6> push(const Vector6& wrench) {
    idleTick();
    EXPECT_EQ(Status::kMotionStarted, unit_->request(torqueControl()));
    const Matrix4 target = Matrix4::Map(unit_->state().O_T_EE.data());
    const Vector7 posture = vector(kReadyPose);
    for (int k = 0; k < 6000; ++k) {
      const auto& pose = unit_->state().O_T_EE;
      const double ramp = std::min(1.0, k / 1000.0);
      pushBody(*world_, hand_, {ramp * wrench[0], ramp * wrench[1], ramp * wrench[2]}, {}, 1,
               {{pose[12], pose[13], pose[14]}});
      pushBody(*world_, hand_, {0, 0, 0}, {ramp * wrench[3], ramp * wrench[4], ramp * wrench[5]},
               1);
      tick([&](const auto& state) { return impedance(state, target, posture); });
    }
    return {Vector6::Map(unit_->state().O_F_ext_hat_K.data()),
            Vector6::Map(unit_->state().K_F_ext_hat_K.data())};
  }

  std::unique_ptr<franka_core::ArmModel> model_;
  std::unique_ptr<World> world_;
  std::unique_ptr<ControlUnit> unit_;
  ArmPlant* arm_{nullptr};
  std::string hand_;
};

TEST_P(ArmInWorld, PushesAreMeasuredWithTheRobotsSign) {
  for (int axis = 0; axis < 6; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      build(0.0);
      Vector6 wrench = Vector6::Zero();
      wrench[axis] = sign * (axis < 3 ? 10.0 : 2.0);
      const auto [in_O, in_K] = push(wrench);
      const Eigen::Matrix3d R = Matrix4::Map(unit_->state().O_T_EE.data()).topLeftCorner<3, 3>();
      Vector6 expected_K;
      expected_K << R.transpose() * -wrench.head<3>(), R.transpose() * -wrench.tail<3>();
      const double tolerance_N = 0.005 * 10, tolerance_Nm = 0.005 * 2;
      for (int i = 0; i < 6; ++i) {
        EXPECT_NEAR(-wrench[i], in_O[i], i < 3 ? tolerance_N : tolerance_Nm)
            << "O, push " << axis << ", axis " << i;
        EXPECT_NEAR(expected_K[i], in_K[i], i < 3 ? tolerance_N : tolerance_Nm)
            << "K, push " << axis << ", axis " << i;
      }
    }
  }
}

TEST_P(ArmInWorld, UnconfiguredKilogramReadsItsWeight) {
  build(1.0);
  const auto [in_O, in_K] = push(Vector6::Zero());
  EXPECT_NEAR(0.0, in_O[0], 0.05);
  EXPECT_NEAR(0.0, in_O[1], 0.05);
  EXPECT_NEAR(9.81, in_O[2], 0.005 * 9.81);
  EXPECT_NEAR(9.81, in_K.head<3>().norm(), 0.005 * 9.81);
}

TEST_P(ArmInWorld, IdleHoldsAgainstAPush) {
  idleTick();
  for (int k = 0; k < 2000; ++k) {
    pushBody(*world_, hand_, {10, 0, 0}, {0, 0, 0}, 1);
    idleTick();
  }
  double away = 0;
  for (int i = 0; i < 7; ++i) {
    away = std::max(away, std::abs(unit_->state().q[i] - kReadyPose[i]));
    EXPECT_EQ(unit_->state().tau_J_d[i], 0);
  }
  EXPECT_LT(away, 5e-3);
  EXPECT_NEAR(-10, unit_->state().O_F_ext_hat_K[0], 0.05);
  for (int k = 0; k < 3000; ++k) {
    idleTick();
  }
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(kReadyPose[i], unit_->state().q[i], 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, ArmInWorld, testing::Values("panda", "fr3"));

}  // namespace
}  // namespace franka_sim
