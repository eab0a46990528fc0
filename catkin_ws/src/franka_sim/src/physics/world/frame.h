// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>

namespace franka_sim {

/// A link or body by its name: a MuJoCo body and a fixed pose in it.
struct Frame {
  int body;
  Eigen::Isometry3d pose;
};

/// The same with its name.
struct NamedFrame {
  std::string name;
  Frame frame;
};

}  // namespace franka_sim
