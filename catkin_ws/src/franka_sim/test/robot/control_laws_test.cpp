// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Torques of the control laws, against independent results.
#include "robot/laws/control_laws.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "fci_fixture.h"
#include "robot/configuration.h"
#include "robot/estimator/estimate.h"
#include "robot/estimator/state_estimator.h"
#include "robot/laws/cartesian_impedance.h"
#include "robot/laws/control_task.h"
#include "robot/laws/joint_impedance.h"

namespace franka_sim::test {

namespace {

class Laws : public FciTest {
 protected:
  void hold(ControllerMode controller, int ticks) {
    const RobotState start = unit.state();
    startMove(controller == ControllerMode::kCartesianImpedance
                  ? MotionGeneratorMode::kCartesianPosition
                  : MotionGeneratorMode::kJointPosition,
              controller);
    drive(ticks, [&](int, const RobotState&) { return still(start); });
    ASSERT_EQ(RobotMode::kMove, unit.state().robot_mode);
  }
};

TEST_F(Laws, JointStiffnessMatchesItsSetting) {
  ignoreCollisions();
  const std::array<double, 7> K{{400, 600, 800, 1000, 300, 200, 100}};
  ASSERT_EQ(Status::kSuccess, unit.request(codec::SetJointImpedanceRequest{K}));
  arm.push = {{5, 8, -6, 0.5, 0.4, -0.3}};
  hold(ControllerMode::kJointImpedance, 6000);
  for (std::size_t i = 0; i < 7; i++) {
    const double spring = unit.state().q_d[i] - unit.state().q[i];
    EXPECT_NEAR(K[i], unit.state().tau_ext_hat_filtered[i] / spring, 0.005 * K[i]) << i;
  }
}

TEST_F(Laws, CartesianStiffnessMatchesItsSettingAlongEachAxisOfK) {
  // K is away from the end effector, and turned about z.
  const Transform EE_T_K{{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.1, -0.2, 0.05, 1}};
  arm.push_frame = multiply(parameters.F_T_NE, EE_T_K);
  const auto pose = [&] {
    return Eigen::Matrix4d::Map(multiply(unit.state().O_T_EE, EE_T_K).data()).eval();
  };
  for (std::size_t row = 0; row < 12; row++) {
    const std::size_t axis = row % 6;
    const bool guided = row >= 6;
    const std::array<double, 6> K = guided
                                        ? std::array<double, 6>{{3000, 3000, 3000, 300, 300, 300}}
                                        : std::array<double, 6>{{300, 900, 2000, 20, 40, 80}};
    standAt(kReady);
    ignoreCollisions();
    ASSERT_EQ(Status::kSuccess, unit.request(codec::SetEEToKRequest{EE_T_K}));
    if (guided) {
      ASSERT_EQ(Status::kSuccess, unit.request(codec::SetGuidingModeRequest{{}, true}));
    } else {
      ASSERT_EQ(Status::kSuccess, unit.request(codec::SetCartesianImpedanceRequest{K}));
    }
    const Eigen::Matrix4d from = pose();
    const Eigen::Matrix3d R = from.topLeftCorner<3, 3>();
    Eigen::Vector3d load = Eigen::Vector3d::Zero();
    load[static_cast<int>(axis % 3)] = axis < 3 ? 1.5 : 0.1;
    const Eigen::Vector3d in_O = R * load;
    const std::size_t offset = axis < 3 ? 0 : 3;
    for (std::size_t i = 0; i < 3; i++) {
      arm.push[offset + i] = in_O[static_cast<int>(i)];
    }
    if (guided) {
      unit.request(Guiding{true});
      run(9000);
    } else {
      hold(ControllerMode::kCartesianImpedance, 9000);
    }
    arm.push.fill(0.0);
    const Eigen::Matrix4d now = pose();
    double moved = 0.0;
    if (axis < 3) {
      moved = (R.transpose() * (now - from).topRightCorner<3, 1>())[static_cast<int>(axis)];
    } else {
      const Eigen::Matrix3d turn = R.transpose() * now.topLeftCorner<3, 3>();
      const int k = static_cast<int>(axis - 3);
      moved = 0.5 * (turn((k + 2) % 3, (k + 1) % 3) - turn((k + 1) % 3, (k + 2) % 3));
    }
    const double applied = axis < 3 ? 1.5 : 0.1;
    EXPECT_NEAR(K[axis], applied / moved, 0.005 * K[axis]) << row;
  }
}

TEST_F(Laws, BothControllersAreStableAtEveryStiffness) {
  // A kick, then half a second: by then an unstable pose grows, a stable one is at rest.
  std::mt19937 random(11);
  const franka_core::ArmLimits& limits = franka_core::kFerLimits;
  int unstable[2] = {0, 0};
  for (int sample = 0; sample < 400; sample++) {
    std::array<double, 7> q;
    for (std::size_t i = 0; i < 7; i++) {
      q[i] = std::uniform_real_distribution<>(limits.q_min[i], limits.q_max[i])(random);
    }
    const double share = std::uniform_real_distribution<>(0.0, 1.0)(random);
    for (int law = 0; law < 2; law++) {
      FakeArm plant(parameters.model, q);
      plant.payload = parameters.end_effector;
      JointImpedance joints({{14250 * share, 14250 * share, 14250 * share, 14250 * share,
                              14250 * share, 14250 * share, 14250 * share}},
                            parameters.rotor_inertia);
      franka_core::ArmDynamics d;
      double speed = 0.0;
      CartesianImpedanceInput in;
      for (int tick = 0; tick < 600; tick++) {
        const ArmMeasurement m = plant.measure();
        parameters.model.computeDynamics(franka_core::ArmFrame::kEndEffector, m.q, m.dq,
                                         parameters.F_T_NE, franka_core::kIdentityTransform,
                                         parameters.end_effector, parameters.gravity, d);
        std::array<double, 7> tau;
        if (law == 0) {
          tau = joints.torque(q, {}, m.q, m.dq, d.mass, d.coriolis);
        } else {
          if (tick == 0) {
            in.O_T_EE_d = d.pose;
          }
          in.O_T_EE = d.pose;
          in.EE_T_K = franka_core::kIdentityTransform;
          in.O_dP_EE_d = {};
          in.O_J_EE = d.zero_jacobian;
          in.mass = d.mass;
          in.q_d = q;
          in.q = m.q;
          in.dq = m.dq;
          in.coriolis = d.coriolis;
          in.rotor_inertia = parameters.rotor_inertia;
          in.K = {
              {3000 * share, 3000 * share, 3000 * share, 300 * share, 300 * share, 300 * share}};
          tau = cartesianImpedance(in);
        }
        for (std::size_t i = 0; i < 7; i++) {
          tau[i] += d.gravity[i];
        }
        plant.push =
            tick < 10 ? std::array<double, 6>{{5, -5, 5, 0.3, 0.3, -0.3}} : std::array<double, 6>{};
        plant.applyTorques(tau);
        plant.step();
        if (tick >= 500) {
          for (const double dq : plant.dq()) {
            speed = std::max(speed, std::abs(dq));
          }
        }
      }
      unstable[law] += !(speed < 0.2);
    }
  }
  EXPECT_EQ(0, unstable[0]) << "joint impedance";
  EXPECT_EQ(0, unstable[1]) << "Cartesian impedance";
}

TEST(CartesianImpedance, DampsEachAxisByItsOwnStiffness) {
  const ControlUnitParameters parameters = pandaWithHand();
  CartesianImpedanceInput in;
  in.q = in.q_d = kReady;
  in.dq = {{0.3, -0.2, 0.5, 0.1, -0.4, 0.2, 0.6}};
  franka_core::ArmDynamics d;
  parameters.model.computeDynamics(franka_core::ArmFrame::kEndEffector, in.q, in.dq,
                                   parameters.F_T_NE, franka_core::kIdentityTransform,
                                   parameters.end_effector, parameters.gravity, d);
  in.O_T_EE_d = in.O_T_EE = d.pose;
  in.EE_T_K = franka_core::kIdentityTransform;
  in.O_dP_EE_d = {};
  in.O_J_EE = d.zero_jacobian;
  in.mass = d.mass;
  in.coriolis = {};
  in.rotor_inertia = parameters.rotor_inertia;
  in.nullspace_stiffness = 0.0;
  in.K = {{300, 900, 2000, 20, 40, 80}};

  // The formula of the header, by an inverse of the whole matrix.
  Eigen::Matrix<double, 7, 7> M = Eigen::Map<const Eigen::Matrix<double, 7, 7>>(d.mass.data());
  M.diagonal() += Eigen::Map<const Eigen::Matrix<double, 7, 1>>(in.rotor_inertia.data());
  const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix4d>(d.pose.data()).topLeftCorner<3, 3>();
  Eigen::Matrix<double, 6, 7> J =
      Eigen::Map<const Eigen::Matrix<double, 6, 7>>(d.zero_jacobian.data());
  J.topRows<3>() = (R.transpose() * J.topRows<3>()).eval();
  J.bottomRows<3>() = (R.transpose() * J.bottomRows<3>()).eval();
  const Eigen::Matrix<double, 6, 6> mobility = J * M.inverse() * J.transpose();
  Eigen::Matrix<double, 6, 1> wrench =
      -J * Eigen::Map<const Eigen::Matrix<double, 7, 1>>(in.dq.data());
  for (int i = 0; i < 6; i++) {
    wrench[i] *= 1.4 * std::sqrt(in.K[static_cast<std::size_t>(i)] / mobility(i, i));
  }
  const Eigen::Matrix<double, 7, 1> expected = J.transpose() * wrench;
  const std::array<double, 7> tau = cartesianImpedance(in);
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_NEAR(expected[static_cast<int>(i)], tau[i], 1e-9) << i;
  }
}

TEST(JointImpedance, IsSpringDamperAndCoriolis) {
  std::array<double, 49> mass{};
  for (std::size_t i = 0; i < 7; i++) {
    mass[8 * i] = 0.9;
  }
  std::array<double, 7> k{{400, 100, 0, 0, 0, 0, 0}};
  std::array<double, 7> b;
  b.fill(0.1);
  const JointImpedance law(k, b);
  const std::array<double, 7> tau =
      law.torque({{0.1, 0, 0.5}}, {{0, 0.2, 1}}, {}, {{0.3, 0, 0}}, mass, {{0, 0, 0, 7}});
  EXPECT_NEAR(400 * 0.1 - 1.4 * 20 * 0.3, tau[0], 1e-12);
  EXPECT_NEAR(1.4 * 10 * 0.2, tau[1], 1e-12);
  EXPECT_EQ(0.0, tau[2]) << "no stiffness, no damping";
  EXPECT_EQ(7.0, tau[3]);
}

TEST(ControlLaws, FadeFromOneLawToTheNext) {
  const ControlUnitParameters parameters = pandaOverFci();
  const Configuration configuration{parameters};
  RobotState state;
  StateEstimator estimator{configuration, state};
  estimator.update({kReady}, parameters.nominal);
  ControlLaws laws(configuration);
  ControlTask task;
  task.mode = RobotMode::kMove;
  task.controller = ControllerMode::kExternalController;
  task.tau = {{10, 0, 0, 0, 0, 0, 0}};
  task.law_switch = LawSwitch::kFromZero;
  const Estimate& estimate = estimator.estimate();
  laws.torques(task, state, estimate);
  task.tau.fill(0.0);
  task.law_switch = LawSwitch::kBlend;
  EXPECT_NEAR(9.0, laws.torques(task, state, estimate)[0] - estimate.dynamics.gravity[0], 1e-12)
      << "1000 Nm/s (protocol 5.5)";
}

}  // namespace

}  // namespace franka_sim::test
