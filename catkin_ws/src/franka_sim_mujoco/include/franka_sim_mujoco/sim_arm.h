// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_hw/control_mode.h>
#include <franka_hw/latest.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim_mujoco/arm_commands.h>
#include <franka_sim_mujoco/command_shaper.h>
#include <ros/time.h>

#include <array>
#include <atomic>
#include <cstdint>

namespace franka_sim_mujoco {

/// How an arm under ros_control behaves beside its control unit's own parameters.
struct SimArmOptions {
  /// Weight of a new sample of external torque and wrench, 0 to 1 (1: no filter on top of the
  /// control unit's own).
  double filter_alpha{1.0};
  ShapingOptions shaping{};
  /// The controller of the robot that follows motions without torques of the user's.
  franka_core::ControllerMode internal_controller{franka_core::ControllerMode::kJointImpedance};
};

/// One arm under ros_control: the control unit between the plant and the controllers, the state
/// they see, and whether their commands reach it.
///
/// The stepping thread owns it; read, write and the control* functions are real-time safe (no
/// allocation, lock, log or throw). What is marked so may be asked by any thread.
class SimArm {
 public:
  /// How far a switch of the controllers is.
  enum class Switch {
    kDone,     ///< the motion runs; or none can, and the controllers are disconnected
    kOngoing,  ///< the arm must come to rest before its next motion
    kRefused,  ///< the motion cannot start, see refusal()
  };
  /// Why the last motion did not start.
  enum class Refusal { kNone, kSingular, kNotAtRest };

  /// What ended a motion.
  struct Abort {
    std::uint64_t count{0};  ///< of motions that errors have ended so far
    std::array<bool, franka_core::kErrorCount> errors{};
    franka_sim::Collision joint_collision, cartesian_collision;
    std::array<double, 16> pose{};  ///< that was commanded last
  };

  SimArm(const franka_sim::ControlUnitParameters& parameters, franka_sim::ArmPlant& plant,
         const SimArmOptions& options);

  /// First half of a tick: refreshes `state`, and starts a motion that was waiting for rest.
  void read(const ros::Time& time) noexcept;
  /// Second half: what the connected controllers command reaches the unit. Torques that are not
  /// finite are ignored as a whole, the last ones are held; other commands that are not finite end
  /// the motion with an error.
  void write() noexcept;

  /// The controllers of the arm change. Torques alone connect at once; motions when the arm rests.
  /// Commands are reset to where the arm is wanted. Nothing is connected while the user stop is
  /// pressed, after an error or without connection, see needsRecovery().
  /// @param mode what will be claimed @param without what is claimed if the new controllers cannot
  /// start after all
  void control(franka_hw::ControlMode mode, franka_hw::ControlMode without) noexcept;
  /// Running controllers were restarted: connects them again after a recovery.
  void controlRestarts() noexcept;
  Switch switchResult() const noexcept { return switch_; }
  /// What is claimed, connected or not.
  franka_hw::ControlMode mode() const noexcept { return mode_; }

  /// The external activation device. Pressed: brakes; commands stay without effect until a
  /// recovery.
  void setUserStop(bool pressed) noexcept;
  /// Begins a recovery. @returns false while the user stop is pressed, the brakes are closed, or
  /// the arm stands beyond a limit after an error
  bool recover() noexcept;
  /// Whether a recovery still waits for standstill.
  bool recovering() const noexcept;
  /// Takes or gives back the connection that controllers command through.
  /// @returns false when controllers command the arm
  bool setConnected(bool connected) noexcept;

  /// The world was reset: what runs starts anew from where the arm stands in the next tick.
  void worldWasReset() noexcept;
  /// The joints were put elsewhere: the arm holds there, and its controllers, which would lead it
  /// back, are disconnected until they are restarted.
  void jointsWerePlaced() noexcept;

  franka_sim::ControlUnit& unit() noexcept { return unit_; }
  franka::RobotState& state() noexcept { return state_; }
  ArmCommands& commands() noexcept { return commands_; }

  /// Any thread.
  bool userStopped() const noexcept { return user_stopped_.load(std::memory_order_relaxed); }
  bool connected() const noexcept { return connected_.load(std::memory_order_relaxed); }
  /// Whether the arm waits for franka_control/error_recovery. Any thread.
  bool needsRecovery() const noexcept { return faulty_.load(std::memory_order_relaxed); }
  /// How many commands were not finite so far. Any thread.
  std::uint64_t refusedCommands() const noexcept {
    return refused_commands_.load(std::memory_order_relaxed);
  }
  /// How the last motion was ended by errors, for the log. One thread.
  const Abort& lastAbort() noexcept { return abort_.read(); }
  /// Why the last switch was refused. Any thread.
  Refusal refusal() const noexcept { return refusal_.load(std::memory_order_relaxed); }

 private:
  bool generates() const noexcept;
  bool canConnect() const noexcept;
  void connect() noexcept;
  void tryToStart() noexcept;
  void stopMotion() noexcept;
  void refuse(Refusal why) noexcept;
  void resetCommands() noexcept;
  void watch() noexcept;
  const franka_core::RobotCommand* command() noexcept;
  void filter() noexcept;
  /// Brings what controllers see up to date.
  void show() noexcept;
  void showContacts() noexcept;

  franka_sim::ControlUnit unit_;
  franka_sim::ArmPlant& plant_;
  SimArmOptions options_;
  bool filter_is_fresh_{true};
  std::array<double, 7> tau_ext_filtered_{};
  std::array<double, 6> O_F_ext_filtered_{}, K_F_ext_filtered_{};
  franka::RobotState state_{};
  franka::Duration time_{};
  ArmCommands commands_;
  franka_core::RobotCommand command_{};
  franka_hw::ControlMode mode_{franka_hw::ControlMode::None};
  franka_hw::ControlMode fallback_{franka_hw::ControlMode::None};
  Switch switch_{Switch::kDone};
  int ticks_waited_{0};
  bool needs_recovery_{false};  ///< since a user stop
  std::atomic<bool> user_stopped_{false}, connected_{true}, faulty_{false};
  std::atomic<Refusal> refusal_{Refusal::kNone};
  std::atomic<std::uint64_t> refused_commands_{0};
  Abort last_abort_;
  franka_hw::Latest<Abort> abort_;
};

}  // namespace franka_sim_mujoco
