// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/model_kdl.h>

namespace franka_gazebo {

/// The model of an arm from its URDF, by the name that it has in franka_gazebo.
using ModelKDL = franka_hw::ModelKDL;

}  // namespace franka_gazebo
