// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/internal/hardware_resource_manager.h>

#include <array>
#include <cstddef>

namespace franka_hw {

/// What both Cartesian command handles have in common: reads the state of one arm and commands
/// `kSize` numbers with an optional elbow.
///
/// Refers to command arrays of its hardware and must not outlive them. Real-time safe.
template <std::size_t kSize>
class FrankaCartesianCommandHandle : public FrankaStateHandle {
 public:
  FrankaCartesianCommandHandle() = delete;

  /// @param command as in the derived class
  /// @param elbow (q3 [rad], sign of the fourth joint); (0, 0) leaves the elbow free
  FrankaCartesianCommandHandle(const FrankaStateHandle& franka_state_handle,
                               std::array<double, kSize>& command, std::array<double, 2>& elbow)
      : FrankaStateHandle(franka_state_handle), command_(&command), elbow_(&elbow) {}

  /// Sets the command and leaves the elbow free.
  void setCommand(const std::array<double, kSize>& command) noexcept {
    *command_ = command;
    elbow_->fill(0.0);
  }

  /// Sets the command together with an elbow configuration.
  void setCommand(const std::array<double, kSize>& command,
                  const std::array<double, 2>& elbow) noexcept {
    *command_ = command;
    *elbow_ = elbow;
  }

  /// The last command.
  const std::array<double, kSize>& getCommand() const noexcept { return *command_; }

 private:
  std::array<double, kSize>* command_;
  std::array<double, 2>* elbow_;
};

/// Commands a Cartesian pose: O_T_EE, 4x4 column-major [m].
class FrankaCartesianPoseHandle : public FrankaCartesianCommandHandle<16> {
 public:
  using FrankaCartesianCommandHandle::FrankaCartesianCommandHandle;
};

/// Provides FrankaCartesianPoseHandles and claims the arm for the controller that gets one.
class FrankaPoseCartesianInterface
    : public hardware_interface::HardwareResourceManager<FrankaCartesianPoseHandle,
                                                         hardware_interface::ClaimResources> {};

/// Commands a Cartesian velocity O_dP_EE: linear [m/s], then angular velocity [rad/s] in O.
class FrankaCartesianVelocityHandle : public FrankaCartesianCommandHandle<6> {
 public:
  using FrankaCartesianCommandHandle::FrankaCartesianCommandHandle;
};

/// Provides FrankaCartesianVelocityHandles and claims the arm for the controller that gets one.
class FrankaVelocityCartesianInterface
    : public hardware_interface::HardwareResourceManager<FrankaCartesianVelocityHandle,
                                                         hardware_interface::ClaimResources> {};

}  // namespace franka_hw
