// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

namespace hardware_interface {

/// Resources that one controller holds on one hardware interface.
struct InterfaceResources {
  InterfaceResources() = default;
  InterfaceResources(const std::string& hw_iface, const std::set<std::string>& res)
      : hardware_interface(hw_iface), resources(res) {}

  std::string hardware_interface;   ///< C++ type name of the interface, with namespaces
  std::set<std::string> resources;  ///< names, of joints for example
};

}  // namespace hardware_interface
