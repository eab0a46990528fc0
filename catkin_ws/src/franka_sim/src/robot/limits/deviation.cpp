// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/limits/deviation.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace franka_sim {

bool isDeviation(const franka_core::fci::Deviation& deviation) noexcept {
  for (const double bound : {deviation.translation, deviation.rotation, deviation.elbow}) {
    if (!std::isfinite(bound) || bound <= 0.0) {
      return false;
    }
  }
  return true;
}

bool deviates(const franka_core::RobotState& state,
              const franka_core::fci::Deviation& allowed) noexcept {
  const Eigen::Map<const Eigen::Matrix4d> desired(state.O_T_EE_d.data());
  const Eigen::Map<const Eigen::Matrix4d> measured(state.O_T_EE.data());
  const Eigen::Vector3d away = desired.topRightCorner<3, 1>() - measured.topRightCorner<3, 1>();
  const Eigen::Matrix3d turn =
      measured.topLeftCorner<3, 3>().transpose() * desired.topLeftCorner<3, 3>();
  return away.norm() > allowed.translation || Eigen::AngleAxisd(turn).angle() > allowed.rotation ||
         std::abs(state.elbow_d[0] - state.elbow[0]) > allowed.elbow;
}

}  // namespace franka_sim
