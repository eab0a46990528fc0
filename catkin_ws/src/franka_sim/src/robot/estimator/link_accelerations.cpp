// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/estimator/link_accelerations.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>

namespace franka_sim {

// Recursion from base to flange, in the axes of the present link.
LinkAccelerations linkAccelerations(const franka_core::ArmModel& model,
                                    const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                    const std::array<double, 7>& ddq,
                                    const std::array<double, 3>& gravity_earth) noexcept {
  using Eigen::Vector3d;
  LinkAccelerations readings;
  const Vector3d z = Vector3d::UnitZ();
  Vector3d w = Vector3d::Zero();
  Vector3d dw = Vector3d::Zero();
  Vector3d a = -Vector3d(gravity_earth.data());
  for (std::size_t i = 0; i < 6; i++) {
    const Eigen::Map<const Eigen::Matrix4d> origin(model.links()[i].origin.data());
    const Vector3d p = origin.topRightCorner<3, 1>();
    a += dw.cross(p) + w.cross(w.cross(p));
    Eigen::Map<Vector3d>(readings.bottom[i].data()) = a;

    const Eigen::Matrix3d R =
        origin.topLeftCorner<3, 3>() * Eigen::AngleAxisd(q[i], z).toRotationMatrix();
    a = (R.transpose() * a).eval();
    w = (R.transpose() * w).eval();
    dw = (R.transpose() * dw + ddq[i] * z + w.cross(dq[i] * z)).eval();
    w += dq[i] * z;
    Eigen::Map<Vector3d>(readings.top[i].data()) = a;
  }
  return readings;
}

}  // namespace franka_sim
