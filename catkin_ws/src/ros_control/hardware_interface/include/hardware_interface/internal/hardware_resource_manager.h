// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/hardware_interface.h>
#include <hardware_interface/internal/resource_manager.h>

#include <stdexcept>
#include <string>

namespace hardware_interface {

/// getHandle claims the resource: for commands, which only one controller may give.
struct ClaimResources {
  static void claim(HardwareInterface* hw, const std::string& name) { hw->claim(name); }
};

/// getHandle claims nothing: for states, which all may read.
struct DontClaimResources {
  static void claim(HardwareInterface* /*hw*/, const std::string& /*name*/) {}
};

/// Base of hardware interfaces: named handles, and a policy whether getHandle claims. For start-up
/// and the initialization of controllers. Called by one thread at a time. Not real-time safe.
template <class ResourceHandle, class ClaimPolicy = DontClaimResources>
class HardwareResourceManager : public HardwareInterface, public ResourceManager<ResourceHandle> {
 public:
  typedef ResourceHandle ResourceHandleType;

  /// A copy of the named handle, claimed according to the policy. A failed look-up claims nothing.
  /// @throws HardwareInterfaceException for an unknown name.
  ResourceHandle getHandle(const std::string& name) {
    try {
      ResourceHandle handle = ResourceManager<ResourceHandle>::getHandle(name);
      ClaimPolicy::claim(this, name);
      return handle;
    } catch (const std::logic_error& error) {
      throw HardwareInterfaceException(error.what());
    }
  }
};

}  // namespace hardware_interface
