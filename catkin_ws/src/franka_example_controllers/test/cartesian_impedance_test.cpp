// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

// The law compared with an independent computation of the same formulas: orientation errors by
// rotation matrices, the null space by singular values, gains by their closed form in time.

#include <franka_example_controllers/cartesian_impedance.h>
#include <gtest/gtest.h>
#include <rt_guard/rt_guard.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace franka_example_controllers {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector7 = CartesianImpedance::Vector7;
using Arm = CartesianImpedance::Arm;

constexpr double kFar = 1e9;  // a torque out of reach: for tests without saturation

class Random {
 public:
  double number(double low = -1.0, double high = 1.0) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  Eigen::Quaterniond rotation() {
    return Eigen::Quaterniond(number(), number(), number(), number()).normalized();
  }
  Eigen::Isometry3d pose() {
    Eigen::Isometry3d result(rotation());
    result.translation() << number(), number(), number();
    return result;
  }
  Arm arm() {
    Arm arm{};
    put(pose(), arm);
    for (double& value : arm.zero_jacobian) {
      value = number();
    }
    for (std::size_t i = 0; i < 7; ++i) {
      arm.coriolis[i] = number(-5.0, 5.0);
      arm.q[i] = number(-3.0, 3.0);
      arm.dq[i] = number(-2.0, 2.0);
    }
    return arm;
  }
  static void put(const Eigen::Isometry3d& pose, Arm& arm) {
    Eigen::Map<Eigen::Matrix4d>(arm.O_T_EE.data()) = pose.matrix();
  }

 private:
  std::mt19937 generator_{1234};
};

Vector7 joints(const std::array<double, 7>& values) {
  return Eigen::Map<const Vector7>(values.data());
}

/// Torques of the formulas, for given gains and equilibrium.
Vector7 expectedTorque(const Arm& arm, const Eigen::Isometry3d& desired, const Vector7& q_start,
                       double kt, double kr, double dt, double dr, double kn) {
  const Eigen::Map<const Eigen::Matrix<double, 6, 7>> J(arm.zero_jacobian.data());
  const Eigen::Map<const Eigen::Matrix4d> O_T_EE(arm.O_T_EE.data());
  // Half-angle vector from measured to desired, in O: sin(angle/2) * axis.
  const Eigen::Matrix3d R = O_T_EE.topLeftCorner<3, 3>();
  const Eigen::AngleAxisd turn(desired.linear() * R.transpose());
  Vector6 wrench;
  const Vector6 twist = J * joints(arm.dq);
  wrench.head<3>() =
      kt * (desired.translation() - O_T_EE.topRightCorner<3, 1>()) - dt * twist.head<3>();
  wrench.tail<3>() = kr * std::sin(turn.angle() / 2.0) * turn.axis() - dr * twist.tail<3>();
  // The null space by singular values: each direction of J keeps 1 - s^2/(s^2 + 0.002^2) of it.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(J.transpose(), Eigen::ComputeThinU);
  const Vector7 elbow = kn * (q_start - joints(arm.q)) - 2.0 * std::sqrt(kn) * joints(arm.dq);
  Vector7 kept = elbow;
  for (int i = 0; i < 6; ++i) {
    const double s2 = std::pow(svd.singularValues()[i], 2);
    kept -= svd.matrixU().col(i) * (svd.matrixU().col(i).dot(elbow) * s2 / (s2 + 4e-6));
  }
  return J.transpose() * wrench + kept + joints(arm.coriolis);
}

/// The law stays within 1 Nm of tau_J_d: if that is the expected result, the output is the result.
Vector7 unsaturated(CartesianImpedance& impedance, Arm arm, const Vector7& expected) {
  Eigen::Map<Vector7>(arm.tau_J_d.data()) = expected;
  return impedance.update(arm);
}

TEST(CartesianImpedance, FollowsTheFormulasOnRandomStates) {
  Random random;
  CartesianImpedance impedance;  // each start is also a restart
  for (int n = 0; n < 1000; ++n) {
    const Arm start = random.arm();
    const Compliance compliance{random.number(0, 400), random.number(0, 30), random.number(0, 100)};
    impedance.start(start.O_T_EE, start.q, compliance.nullspace_stiffness);
    impedance.setCompliance(compliance);

    const Eigen::Isometry3d begin{Eigen::Map<const Eigen::Matrix4d>(start.O_T_EE.data())};
    const Eigen::Isometry3d target = random.pose();
    // Both signs of a quaternion are the same rotation.
    Eigen::Quaterniond orientation(target.linear());
    if (n % 2 == 0) {
      orientation.coeffs() *= -1.0;
    }
    impedance.setEquilibrium(target.translation(), orientation);

    for (int update = 0; update < 30; ++update) {
      // Closed form of 0.5 % per update.
      const double way = 1.0 - std::pow(0.995, update);
      Eigen::Isometry3d desired;
      desired.setIdentity();
      desired.translation() =
          begin.translation() + way * (target.translation() - begin.translation());
      const Eigen::AngleAxisd whole(begin.linear().transpose() * target.linear());
      desired.linear() =
          (begin.linear() * Eigen::AngleAxisd(way * whole.angle(), whole.axis())).eval();
      const double kt = way * compliance.translational_stiffness;
      const double kr = way * compliance.rotational_stiffness;
      const double dt = way * 2.0 * std::sqrt(compliance.translational_stiffness);
      const double dr = way * 2.0 * std::sqrt(compliance.rotational_stiffness);

      const Arm arm = random.arm();
      const Vector7 expected = expectedTorque(arm, desired, joints(start.q), kt, kr, dt, dr,
                                              compliance.nullspace_stiffness);
      const Vector7 actual = unsaturated(impedance, arm, expected);
      ASSERT_LT((actual - expected).lpNorm<Eigen::Infinity>(), 1e-9)
          << "state " << n << ", update " << update;
    }
  }
}

TEST(CartesianImpedance, ResetsItsTargetsWhenRestarted) {
  Random random;
  Arm arm = random.arm();
  arm.dq.fill(0.0);
  arm.coriolis.fill(0.0);
  CartesianImpedance impedance;
  impedance.start(arm.O_T_EE, arm.q, 10.0);
  impedance.setCompliance({400.0, 30.0, 10.0});
  impedance.setEquilibrium({5.0, 5.0, 5.0}, Eigen::Quaterniond::UnitRandom());
  for (int i = 0; i < 100; ++i) {
    impedance.update(arm);
  }
  impedance.start(arm.O_T_EE, arm.q, 10.0);
  for (int i = 0; i < 100; ++i) {
    ASSERT_LT(impedance.update(arm).lpNorm<Eigen::Infinity>(), 1e-12);
  }
}

TEST(CartesianImpedance, ChangesNoTorqueByMoreThanOneNewtonmeter) {
  Random random;
  for (int n = 0; n < 1000; ++n) {
    Arm arm = random.arm();
    CartesianImpedance impedance;
    impedance.start(arm.O_T_EE, arm.q, 100.0);
    for (std::size_t i = 0; i < 7; ++i) {
      arm.q[i] += random.number(-3.0, 3.0);
      arm.tau_J_d[i] = random.number(-87.0, 87.0);
    }
    const Vector7 step = impedance.update(arm) - joints(arm.tau_J_d);
    ASSERT_LE(step.lpNorm<Eigen::Infinity>(), 1.0 + 1e-12);
  }
  const Vector7 from = Vector7::Constant(3.0);
  Vector7 to;
  to << 3.0, 3.5, 2.5, 4.0, 2.0, kFar, -kFar;
  Vector7 limited;
  limited << 3.0, 3.5, 2.5, 4.0, 2.0, 4.0, 2.0;
  EXPECT_EQ(limited, saturateTorqueRate(to, from));
}

TEST(CartesianImpedance, NeitherAllocatesNorLocks) {
  Random random;
  const Arm arm = random.arm();
  CartesianImpedance impedance;
  rt_guard::Scope scope;
  impedance.start(arm.O_T_EE, arm.q, 0.5);
  impedance.setCompliance({200.0, 10.0, 0.5});
  impedance.setEquilibrium({0.3, 0.0, 0.5}, Eigen::Quaterniond::Identity());
  for (int i = 0; i < 1000; ++i) {
    impedance.update(arm);
  }
  EXPECT_EQ(0U, scope.allocations());
  EXPECT_EQ(0U, scope.locks());
}

}  // namespace
}  // namespace franka_example_controllers
