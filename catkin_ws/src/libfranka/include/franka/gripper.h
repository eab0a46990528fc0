// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/gripper_state.h>

#include <cstdint>
#include <memory>
#include <string>

/// @file
/// Contains the franka::Gripper type.

namespace franka {

/// Declared in the vendor's header too; not defined in this library.
class Network;

/// A connection to the Franka Hand of a robot.
///
/// Commands wait for their end, at most 60 s (then a NetworkException reports that the hand has not
/// answered). `stop` from another thread ends a waiting command, which then throws. Thread-safe.
/// Not real-time safe.
class Gripper {
 public:
  /// Version of the protocol.
  using ServerVersion = uint16_t;

  /// Connects: offers the newest protocol, then the hand's.
  /// @param franka_address of the robot with the hand: address or name, optionally with a port
  /// (`host:port`).
  /// @throws NetworkException if the connection cannot be made within 5 s.
  /// @throws IncompatibleVersionException if the hand speaks none of this library's protocols.
  explicit Gripper(const std::string& franka_address);
  Gripper(Gripper&& gripper) noexcept;
  Gripper& operator=(Gripper&& gripper) noexcept;
  ~Gripper() noexcept;

  /// Measures the maximum opening of the fingers. Required after a change of fingers.
  /// @returns whether it succeeded.
  /// @throws CommandException if it failed or was stopped. @throws NetworkException if the
  /// connection is lost.
  bool homing() const;

  /// Grasps an object. It counts as grasped if the distance d between the fingers is
  /// width - epsilon_inner < d < width + epsilon_outer.
  /// @param width of the object [m] @param speed [m/s] @param force [N]
  /// @param epsilon_inner,epsilon_outer tolerances [m]
  /// @returns whether the object is grasped. @throws as homing.
  bool grasp(double width, double speed, double force, double epsilon_inner = 0.005,
             double epsilon_outer = 0.005) const;

  /// Moves the fingers. @param width between them [m] @param speed [m/s]
  /// @returns whether they arrived. @throws as homing.
  bool move(double width, double speed) const;

  /// Ends the running command. @returns whether it succeeded. @throws as homing.
  bool stop() const;

  /// Waits for the next state, as long as Timeouts say: up to a second, for a simulated gripper on
  /// this machine up to five. @throws NetworkException if none comes, or at once if the connection
  /// is lost.
  /// @throws InvalidOperationException if another thread is reading a state.
  GripperState readOnce() const;

  /// The version that the hand speaks.
  ServerVersion serverVersion() const noexcept;

  Gripper(const Gripper&) = delete;
  Gripper& operator=(const Gripper&) = delete;

  class Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace franka
