// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>

#include <string>

namespace hardware_interface_test {

/// The text of the exception that `action` throws; a marker if it throws none of that type.
template <class Action>
std::string refusal(Action action) {
  try {
    action();
  } catch (const hardware_interface::HardwareInterfaceException& error) {
    return error.what();
  }
  return "(nothing was thrown)";
}

}  // namespace hardware_interface_test
