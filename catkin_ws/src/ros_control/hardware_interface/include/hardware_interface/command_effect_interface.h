// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/hardware_resource_manager.h>

#include <functional>
#include <string>
#include <utility>

namespace hardware_interface {

/// Reports whether commands for one joint have an effect at present. Not real-time safe.
class CommandEffectHandle {
 public:
  CommandEffectHandle() = default;

  /// @param reason_without_effect see reasonWithoutEffect(); any thread calls it.
  /// @throws HardwareInterfaceException if it is empty.
  CommandEffectHandle(const std::string& name, std::function<std::string()> reason_without_effect)
      : name_(name), reason_without_effect_(std::move(reason_without_effect)) {
    if (!reason_without_effect_) {
      throw HardwareInterfaceException("Cannot create handle '" + name +
                                       "'. The function of its reason is empty.");
    }
  }

  /// The name of the joint.
  std::string getName() const { return name_; }

  /// Why commands have no effect, and what ends that: a sentence, such as that the robot needs a
  /// recovery. Empty if they have one. Thread-safe.
  std::string reasonWithoutEffect() const {
    return reason_without_effect_ ? reason_without_effect_() : std::string();
  }

 private:
  std::string name_;
  std::function<std::string()> reason_without_effect_;
};

/// An addition that hardware may offer, so that controllers refuse goals which they cannot reach.
/// getHandle claims nothing.
class CommandEffectInterface : public HardwareResourceManager<CommandEffectHandle> {};

}  // namespace hardware_interface
