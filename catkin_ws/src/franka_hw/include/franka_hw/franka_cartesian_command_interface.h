// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/internal/hardware_resource_manager.h>

#include <array>

namespace franka_hw {

/// Reads the state of one arm and commands a Cartesian pose with an optional elbow.
///
/// Refers to command arrays of its hardware and must not outlive them. Real-time safe.
class FrankaCartesianPoseHandle : public FrankaStateHandle {
 public:
  FrankaCartesianPoseHandle() = delete;

  /// @param command O_T_EE, 4x4 column-major [m]
  /// @param elbow (q3 [rad], sign of the fourth joint); (0, 0) leaves the elbow free
  FrankaCartesianPoseHandle(const FrankaStateHandle& franka_state_handle,
                            std::array<double, 16>& command, std::array<double, 2>& elbow)
      : FrankaStateHandle(franka_state_handle), command_(&command), elbow_(&elbow) {}

  /// Commands a pose and leaves the elbow free.
  void setCommand(const std::array<double, 16>& command) noexcept {
    *command_ = command;
    elbow_->fill(0.0);
  }

  /// Commands a pose together with an elbow configuration.
  void setCommand(const std::array<double, 16>& command,
                  const std::array<double, 2>& elbow) noexcept {
    *command_ = command;
    *elbow_ = elbow;
  }

  /// The last commanded pose, column-major.
  const std::array<double, 16>& getCommand() const noexcept { return *command_; }

 private:
  std::array<double, 16>* command_;
  std::array<double, 2>* elbow_;
};

/// Provides FrankaCartesianPoseHandles and claims the arm for the controller that gets one.
class FrankaPoseCartesianInterface
    : public hardware_interface::HardwareResourceManager<FrankaCartesianPoseHandle,
                                                         hardware_interface::ClaimResources> {};

/// Reads the state of one arm and commands a Cartesian velocity with an optional elbow.
///
/// Refers to command arrays of its hardware and must not outlive them. Real-time safe.
class FrankaCartesianVelocityHandle : public FrankaStateHandle {
 public:
  FrankaCartesianVelocityHandle() = delete;

  /// @param command O_dP_EE: linear [m/s], then angular velocity [rad/s] in O
  /// @param elbow (q3 [rad], sign of the fourth joint); (0, 0) leaves the elbow free
  FrankaCartesianVelocityHandle(const FrankaStateHandle& franka_state_handle,
                                std::array<double, 6>& command, std::array<double, 2>& elbow)
      : FrankaStateHandle(franka_state_handle), command_(&command), elbow_(&elbow) {}

  /// Commands a velocity and leaves the elbow free.
  void setCommand(const std::array<double, 6>& command) noexcept {
    *command_ = command;
    elbow_->fill(0.0);
  }

  /// Commands a velocity together with an elbow configuration.
  void setCommand(const std::array<double, 6>& command,
                  const std::array<double, 2>& elbow) noexcept {
    *command_ = command;
    *elbow_ = elbow;
  }

  /// The last commanded velocities [m/s] [rad/s].
  const std::array<double, 6>& getCommand() const noexcept { return *command_; }

 private:
  std::array<double, 6>* command_;
  std::array<double, 2>* elbow_;
};

/// Provides FrankaCartesianVelocityHandles and claims the arm for the controller that gets one.
class FrankaVelocityCartesianInterface
    : public hardware_interface::HardwareResourceManager<FrankaCartesianVelocityHandle,
                                                         hardware_interface::ClaimResources> {};

}  // namespace franka_hw
