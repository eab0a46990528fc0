// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace franka_sim {

/// A contact in a step, with the force that acted on the second geom.
struct GeomContact {
  int geom1, geom2;
  std::array<double, 3> position, force;  ///< world axes [m] [N]
};

}  // namespace franka_sim
