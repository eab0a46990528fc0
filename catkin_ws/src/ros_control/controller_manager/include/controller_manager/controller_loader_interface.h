// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>

#include <memory>
#include <string>
#include <vector>

namespace controller_manager {

/// A source of controllers. The manager makes one call at a time, never from the control loop.
class ControllerLoaderInterface {
 public:
  /// @param name of the loader, shown as the base class of its types
  ControllerLoaderInterface(const std::string& name) : name_(name) {}
  virtual ~ControllerLoaderInterface() = default;

  /// Creates a controller. @throws std::runtime_error with the reason if it cannot.
  virtual controller_interface::ControllerBaseSharedPtr createInstance(
      const std::string& lookup_name) = 0;

  /// The types that createInstance accepts.
  virtual std::vector<std::string> getDeclaredClasses() = 0;

  /// Searches types again. No controller of this loader exists at that time.
  virtual void reload() = 0;

  /// The name of the loader.
  const std::string& getName() { return name_; }

 private:
  const std::string name_;
};

typedef std::shared_ptr<ControllerLoaderInterface> ControllerLoaderInterfaceSharedPtr;

}  // namespace controller_manager
