// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Control laws and geometry of the unit, against independent results.
#include <franka_sim/robot/cartesian_impedance.h>
#include <franka_sim/robot/joint_impedance.h>
#include <franka_sim/robot/link_accelerometers.h>

#include <Eigen/Core>
#include <random>

#include "fci_fixture.h"

namespace franka_sim::test {

namespace {

class Laws : public FciTest {
 protected:
  RobotCommand still() const {
    RobotCommand command;
    command.q_c = start.q_d;
    command.O_T_EE_c = start.O_T_EE_c;
    return command;
  }

  void hold(ControllerMode controller, int ticks) {
    start = unit.state();
    startMove(controller == ControllerMode::kCartesianImpedance
                  ? MotionGeneratorMode::kCartesianPosition
                  : MotionGeneratorMode::kJointPosition,
              controller);
    drive(ticks, [&](int, const RobotState&) { return still(); });
    ASSERT_EQ(RobotMode::kMove, unit.state().robot_mode);
  }

  RobotState start;
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
  const std::array<double, 6> K{{300, 900, 2000, 20, 40, 80}};
  for (std::size_t axis = 0; axis < 6; axis++) {
    standAt(kReady);
    ignoreCollisions();
    ASSERT_EQ(Status::kSuccess, unit.request(codec::SetCartesianImpedanceRequest{K}));
    const Eigen::Matrix4d from = Eigen::Map<const Eigen::Matrix4d>(unit.state().O_T_EE.data());
    const Eigen::Matrix3d R = from.topLeftCorner<3, 3>();
    Eigen::Vector3d load = Eigen::Vector3d::Zero();
    load[static_cast<int>(axis % 3)] = axis < 3 ? 1.5 : 0.1;
    const Eigen::Vector3d in_O = R * load;
    const std::size_t offset = axis < 3 ? 0 : 3;
    for (std::size_t i = 0; i < 3; i++) {
      arm.push[offset + i] = in_O[static_cast<int>(i)];
    }
    hold(ControllerMode::kCartesianImpedance, 9000);
    arm.push.fill(0.0);
    const Eigen::Matrix4d now = Eigen::Map<const Eigen::Matrix4d>(unit.state().O_T_EE.data());
    double moved = 0.0;
    if (axis < 3) {
      moved = (R.transpose() * (now - from).topRightCorner<3, 1>())[static_cast<int>(axis)];
    } else {
      const Eigen::Matrix3d turn = R.transpose() * now.topLeftCorner<3, 3>();
      const int k = static_cast<int>(axis - 3);
      moved = 0.5 * (turn((k + 2) % 3, (k + 1) % 3) - turn((k + 1) % 3, (k + 2) % 3));
    }
    const double applied = axis < 3 ? 1.5 : 0.1;
    EXPECT_NEAR(K[axis], applied / moved, 0.005 * K[axis]) << axis;
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

TEST_F(Laws, AccelerometersReadTheSecondDerivativeOfTheirPosition) {
  std::array<double, 7> q = kReady, dq, ddq;
  for (std::size_t i = 0; i < 7; i++) {
    dq[i] = 0.3 * static_cast<double>(i) - 0.7;
    ddq[i] = 1.1 - 0.4 * static_cast<double>(i);
  }
  const LinkAccelerations readings =
      linkAccelerations(parameters.model, q, dq, ddq, parameters.gravity);
  const double h = 1e-4;
  for (int joint = 0; joint < 6; joint++) {
    const auto at = [&](double t) {
      std::array<double, 7> moved;
      for (std::size_t i = 0; i < 7; i++) {
        moved[i] = q[i] + dq[i] * t + 0.5 * ddq[i] * t * t;
      }
      const std::array<double, 16> T =
          parameters.model.pose(static_cast<franka_core::ArmFrame>(joint), moved);
      return Eigen::Matrix4d(Eigen::Map<const Eigen::Matrix4d>(T.data()));
    };
    const Eigen::Vector3d a = ((at(h) - 2 * at(0) + at(-h)) / (h * h)).topRightCorner<3, 1>() +
                              Eigen::Vector3d(0, 0, 9.81);
    const Eigen::Vector3d top =
        at(0).topLeftCorner<3, 3>() * Eigen::Vector3d(readings.top[joint].data());
    EXPECT_LT((a - top).norm(), 1e-5) << joint;
    EXPECT_NEAR(a.norm(), Eigen::Vector3d(readings.bottom[joint].data()).norm(), 1e-5) << joint;
  }
  run(10);
  EXPECT_NEAR(9.81, unit.state().accelerometer_bottom[0][2], 1e-6);
}

TEST(SelfCollisionGeometry, SegmentDistanceIsTheMinimumOverAllPoints) {
  std::mt19937 random(3);
  std::uniform_real_distribution<> coordinate(-1, 1);
  for (int sample = 0; sample < 300; sample++) {
    std::array<std::array<double, 3>, 4> p;
    for (auto& point : p) {
      point = {{coordinate(random), coordinate(random), coordinate(random)}};
    }
    if (sample % 10 == 0) {
      p[1] = p[0];  // a point
    }
    if (sample % 15 == 0) {
      for (std::size_t k = 0; k < 3; k++) {
        p[3][k] = p[2][k] + 0.7 * (p[1][k] - p[0][k]);  // parallel
      }
    }
    double smallest = 1e9;
    for (int i = 0; i <= 200; i++) {
      for (int j = 0; j <= 200; j++) {
        double sum = 0.0;
        for (std::size_t k = 0; k < 3; k++) {
          const double d =
              p[0][k] + (p[1][k] - p[0][k]) * i / 200.0 - p[2][k] - (p[3][k] - p[2][k]) * j / 200.0;
          sum += d * d;
        }
        smallest = std::min(smallest, std::sqrt(sum));
      }
    }
    const double distance = segmentDistance(p[0], p[1], p[2], p[3]);
    EXPECT_LE(distance, smallest + 1e-12);
    EXPECT_GE(distance, smallest - 0.02);
  }
}

TEST(SelfCollisionGeometry, KnownPosesAreClassified) {
  SelfCollision collision(true);
  const franka_core::ArmModel model = pandaModel();
  EXPECT_GT(collision.closest(model, kReady).distance, 0.01);
  EXPECT_GT(collision.closest(model, {{0, 0, 0, -1.57, 0, 1.57, 0.785}}).distance, 0.01);
  // The hand folded back into the upper arm.
  EXPECT_LT(collision.closest(model, {{0, 1.7, 0, -3.05, 0, 0.0, 0}}).distance, 0.0);
}

TEST(SelfCollisionGeometry, OverlapsMayShrinkButNotGrow) {
  const franka_core::ArmModel model = pandaModel();
  std::mt19937 random(5);
  SelfCollision collision(true);
  std::array<double, 7> q{};
  for (int found = 0; found < 20;) {
    for (std::size_t i = 0; i < 7; i++) {
      q[i] = std::uniform_real_distribution<>(franka_core::kFerLimits.q_min[i],
                                              franka_core::kFerLimits.q_max[i])(random);
    }
    const double before = collision.closest(model, q).distance;
    if (before > -0.002 || before < -0.004) {
      continue;
    }
    found++;
    for (std::size_t joint = 0; joint < 7; joint++) {
      std::array<double, 7> moved = q;
      moved[joint] += 0.02;
      const double after = collision.closest(model, moved).distance;
      collision.begin(model, q);
      EXPECT_FALSE(collision.violated(model, q));
      if (after < before - 2e-4) {
        EXPECT_TRUE(collision.violated(model, moved));
        EXPECT_LT(collision.culprit().distance, 0.0);
      } else if (after > 0.0) {
        EXPECT_FALSE(collision.violated(model, moved));
        EXPECT_TRUE(collision.violated(model, q)) << "an overlap that ended must not return";
      }
    }
  }
}

}  // namespace

}  // namespace franka_sim::test
