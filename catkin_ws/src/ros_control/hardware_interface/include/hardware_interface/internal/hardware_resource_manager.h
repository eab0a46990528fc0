// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/hardware_interface.h>
#include <hardware_interface/internal/resource_manager.h>

#include <stdexcept>
#include <string>

namespace hardware_interface {

/// Getting a handle claims its resource: for commands, which only one controller may give.
struct ClaimResources {
  static void claim(HardwareInterface* hw, const std::string& name) { hw->claim(name); }
};

/// Getting a handle claims nothing: for states, which everybody may read.
struct DontClaimResources {
  static void claim(HardwareInterface* /*hw*/, const std::string& /*name*/) {}
};

/// Base of hardware interfaces: named handles, and a policy that says whether taking one claims it.
/// Used at start-up and while controllers are initialised only; not thread-safe.
template <class ResourceHandle, class ClaimPolicy = DontClaimResources>
class HardwareResourceManager : public HardwareInterface, public ResourceManager<ResourceHandle> {
 public:
  typedef ResourceHandle ResourceHandleType;

  /// A copy of the named handle, claimed if the policy says so. A failed look-up claims nothing.
  /// @throws HardwareInterfaceException when there is none of that name.
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
