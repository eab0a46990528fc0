// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/vacuum_gripper_state.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

/// @file
/// Contains the franka::VacuumGripper type.

namespace franka {

/// Declared in the vendor's header too; not defined in this library.
class Network;

/// A connection to a vacuum gripper. Timeouts as for franka::Gripper. Thread-safe.
/// Not real-time safe.
class VacuumGripper {
 public:
  /// Version of the protocol.
  using ServerVersion = uint16_t;

  /// Profiles of the device's own set-up.
  enum class ProductionSetupProfile { kP0, kP1, kP2, kP3 };

  /// @param franka_address of the robot with the gripper, optionally with a port.
  /// @throws NetworkException if the connection cannot be made within 5 s.
  /// @throws IncompatibleVersionException if the gripper speaks another protocol.
  explicit VacuumGripper(const std::string& franka_address);
  VacuumGripper(VacuumGripper&& vacuum_gripper) noexcept;
  VacuumGripper& operator=(VacuumGripper&& vacuum_gripper) noexcept;
  ~VacuumGripper() noexcept;

  /// Vacuums an object.
  /// @param vacuum to reach [10 mbar] @param timeout to reach it @param profile of the device
  /// @returns whether it was reached.
  /// @throws CommandException if it failed or was stopped. @throws NetworkException if the
  /// connection is lost, or 60 s after the timeout.
  bool vacuum(uint8_t vacuum, std::chrono::milliseconds timeout,
              ProductionSetupProfile profile = ProductionSetupProfile::kP0) const;

  /// Drops the object. @returns whether it succeeded. @throws as vacuum.
  bool dropOff(std::chrono::milliseconds timeout) const;

  /// Ends the running command. @returns whether it succeeded. @throws as vacuum.
  bool stop() const;

  /// Waits for the next state. @throws as Gripper::readOnce.
  VacuumGripperState readOnce() const;

  /// The version that the gripper speaks.
  ServerVersion serverVersion() const noexcept;

  VacuumGripper(const VacuumGripper&) = delete;
  VacuumGripper& operator=(const VacuumGripper&) = delete;

  class Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace franka
