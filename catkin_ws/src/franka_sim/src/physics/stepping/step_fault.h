// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim::physics {

/// A number that is not finite, or beyond MuJoCo's range. MuJoCo itself would reset the whole world
/// and continue (2.2 has no option against that), so it is checked before MuJoCo does.
struct StepFault {
  enum class Where {
    kPosition,
    kVelocity,
    kAcceleration,
    kEngine,  ///< an EngineError; no index and no value
  };
  Where where;
  int index{-1};  ///< in qpos or qvel
  double value{0};
};

}  // namespace franka_sim::physics
