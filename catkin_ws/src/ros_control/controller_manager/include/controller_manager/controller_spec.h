// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>
#include <hardware_interface/controller_info.h>

#include <memory>

namespace controller_manager {

namespace internal {
class ControllerWatch;
}

/// A loaded controller with its properties.
struct ControllerSpec {
  hardware_interface::ControllerInfo info;          ///< name, type and resources
  controller_interface::ControllerBaseSharedPtr c;  ///< the controller itself
  /// Measures the updates and aborts a faulty controller; null unless parameters enable it.
  std::shared_ptr<internal::ControllerWatch> watch;
};

}  // namespace controller_manager
