// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Accelerations of the links.
#include <Eigen/Core>

#include "fci_fixture.h"
#include "robot/estimator/state_estimator.h"

namespace franka_sim::test {

namespace {

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
