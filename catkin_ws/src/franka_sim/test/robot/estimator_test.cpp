// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Parts of the estimator: contacts by their thresholds, the external wrench at K,
// accelerations of the links.
#include <Eigen/Core>
#include <array>

#include "fci_fixture.h"
#include "robot/estimator/contact_monitor.h"
#include "robot/estimator/external_wrench.h"
#include "robot/estimator/link_accelerations.h"
#include "robot/transforms.h"

namespace franka_sim::test {

namespace {

TEST(ContactMonitor, IncludesItsUpperThreshold) {
  ContactMonitor<1> monitor;
  struct Row {
    double value, contact, collision;
    double lower{10};
  };
  for (const Row& row :
       {Row{19, 0, 0, 20}, Row{20, 0, 0, 20}, Row{0, 0, 0}, Row{10, 0, 0}, Row{10.001, 1, 0},
        Row{-10.001, 1, 0}, Row{20, 1, 0}, Row{-20, 1, 0}, Row{-20.001, 0, 1}, Row{0, 0, 1}}) {
    monitor.update({{row.value}}, {{row.lower}}, {{20}});
    EXPECT_EQ(row.contact, monitor.contact()[0]) << row.value;
    EXPECT_EQ(row.collision, monitor.collision()[0]) << row.value;
  }
  monitor.clear();
  EXPECT_EQ(0.0, monitor.collision()[0]);
}

TEST(ExternalWrench, InvertsTheTransposedJacobianAtK) {
  // A Jacobian of a Cartesian machine whose seventh joint equals the first.
  std::array<double, 42> J{};
  for (std::size_t i = 0; i < 6; i++) {
    J[6 * i + i] = 1.0;
  }
  J[36] = 1.0;
  Transform O_T_EE = {{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}};
  Transform EE_T_K = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}};
  ExternalWrench map;
  map.update(O_T_EE, J, EE_T_K);
  ASSERT_FALSE(map.singular());
  // K lies at r = (0, 1, 0) in O; a force f and a moment m there turn the joints by f, and m + r x
  // f.
  const std::array<double, 6> F{{1, 2, 3, 4, 5, 6}};
  const std::array<double, 7> tau{{1, 2, 3, 4 + 3, 5, 6 - 1, 1}};
  const std::array<double, 6> wrench = map.inBase(tau);
  expectNear(F, wrench, 1e-12);
  const std::array<double, 6> in_K = map.inStiffness(wrench);
  const std::array<double, 6> expected{{2, -1, 3, 5, -4, 6}};
  expectNear(expected, in_K, 1e-12);
}

using Accelerometers = FciTest;

TEST_F(Accelerometers, ReadTheSecondDerivativeOfTheirPosition) {
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

}  // namespace

}  // namespace franka_sim::test
