// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_sim_mujoco/robot/control_unit.h>
#include <franka_sim_mujoco/robot/plant.h>
#include <ros/time.h>

#include <array>
#include <atomic>
#include <cstdint>

namespace franka_sim_mujoco {

/// One arm under ros_control: the control unit between the plant and the controllers, the state
/// they see, and whether their commands reach it.
///
/// The stepping thread owns it; read, write and the control* functions are real-time safe (no
/// allocation, lock, log or throw). What is marked so may be asked by any thread.
class SimArm {
 public:
  /// @param filter_alpha weight of a new sample of external torque and wrench, 0 to 1 (1: no filter
  /// on top of the control unit's own)
  SimArm(const ControlUnitParameters& parameters, ArmPlant& plant, double filter_alpha);

  /// First half of a tick: refreshes `state`.
  void read(const ros::Time& time) noexcept;
  /// Second half. @param torque the controllers' torques without gravity [Nm]; ignored unless they
  /// are connected, and as a whole when one is not finite: the last torque is then held
  void write(const std::array<double, 7>& torque) noexcept;

  /// An arm controller starts: its commands take effect, except while the user stop is pressed.
  void controlStarts() noexcept;
  /// No arm controller is left: the arm holds where it stands.
  void controlStops() noexcept;
  /// Running controllers were restarted: connects them again after a recovery.
  void controlRestarts() noexcept;

  /// The external activation device. Pressed: brakes; commands stay without effect until a
  /// recovery.
  void setUserStop(bool pressed) noexcept;
  /// @returns kNotPossible while the user stop is pressed
  RequestStatus recover() noexcept;

  void worldWasReset() noexcept;

  ControlUnit& unit() noexcept { return unit_; }
  franka::RobotState& state() noexcept { return state_; }

  /// Any thread.
  bool userStopped() const noexcept { return user_stopped_.load(std::memory_order_relaxed); }
  /// How many commands were not finite so far. Any thread.
  std::uint64_t refusedCommands() const noexcept {
    return refused_commands_.load(std::memory_order_relaxed);
  }

 private:
  void connect() noexcept;
  void filter() noexcept;

  ControlUnit unit_;
  ArmPlant& plant_;
  double filter_alpha_;
  bool filter_is_fresh_{true};
  std::array<double, 7> tau_ext_filtered_{};
  std::array<double, 6> O_F_ext_filtered_{}, K_F_ext_filtered_{};
  franka::RobotState state_{};
  franka_core::RobotCommand command_{};
  bool claimed_{false};         ///< an arm controller runs
  bool needs_recovery_{false};  ///< since a user stop
  std::atomic<bool> user_stopped_{false};
  std::atomic<std::uint64_t> refused_commands_{0};
};

}  // namespace franka_sim_mujoco
