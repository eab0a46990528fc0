// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>
#include <hardware_interface/controller_info.h>

namespace controller_manager {

/// A loaded controller and what is known about it.
struct ControllerSpec {
  hardware_interface::ControllerInfo info;
  controller_interface::ControllerBaseSharedPtr c;
};

}  // namespace controller_manager
