// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_hw/control_mode.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim_mujoco/arm_commands.h>
#include <franka_sim_mujoco/command_shaper.h>
#include <realtime_tools/latest_value.h>
#include <ros/time.h>

#include <array>
#include <atomic>
#include <cstdint>

namespace franka_sim_mujoco {

/// Options of an arm under ros_control besides its control unit's own parameters.
struct SimArmOptions {
  /// Weight of a new sample of external torque and wrench, 0 to 1 (1: no filter in addition to the
  /// control unit's own).
  double filter_alpha{1.0};
  ShapingOptions shaping{};
  /// Ticks from one update of the controllers to the next. Motions approach a new command within
  /// that time, so that the robot is not driven in steps.
  int control_ticks{1};
  /// The internal controller that follows motions without torques of a user's controller.
  franka_core::ControllerMode internal_controller{franka_core::ControllerMode::kJointImpedance};
};

/// One arm under ros_control: connects its control unit with the plant and the controllers,
/// provides the state for the controllers, and decides whether their commands reach the control
/// unit.
///
/// Called by the stepping thread; other threads call only the functions whose comment allows it.
/// Real-time safe. Exception: the constructor.
class SimArm {
 public:
  /// The progress of a switch of controllers.
  enum class Switch {
    kDone,     ///< the motion runs; or none can, and the controllers are disconnected
    kOngoing,  ///< the arm must come to rest before its next motion
    kRefused,  ///< the motion cannot start, see refusal(); what ran before goes on
  };
  /// Why the last motion did not start.
  enum class Refusal { kNone, kSingular, kNotAtRest };

  /// The cause of the end of a motion.
  struct Abort {
    std::uint64_t count{0};  ///< number of motions that errors have ended so far
    std::array<bool, franka_core::kErrorCount> errors{};
    franka_sim::Collision joint_collision, cartesian_collision;
    std::array<double, 16> pose{};  ///< the last commanded pose
  };

  SimArm(const franka_sim::ControlUnitParameters& parameters, franka_sim::ArmPlant& plant,
         const SimArmOptions& options);

  /// First half of a tick: updates `state`, and starts a motion that waits for rest.
  void read(const ros::Time& time) noexcept;
  /// Call before write(): computes `applied` of this tick.
  void approachCommands() noexcept;
  /// Second half: passes `applied` of the connected controllers to the unit. If a torque is not
  /// finite, all torques are ignored and the last ones are held; other commands that are not finite
  /// end the motion with an error.
  void write() noexcept;

  /// Whether control() would refuse to start controllers, because no Cartesian motion can start
  /// where the arm would come to rest.
  bool refuses(franka_hw::ControlMode starts, franka_hw::ControlMode stops) const noexcept;
  /// The controllers of the arm change; a restarted one is in both. Torques alone connect at once;
  /// motions when the arm rests. Commands are reset to the desired position and the commanded pose.
  /// No controllers are connected while the user stop is pressed, after an error or without
  /// connection, see needsRecovery(). Controllers that remain are connected again in any case, also
  /// if the new ones cannot start.
  /// @param starts, stops claims of the controllers; none if they command something else
  /// @returns false if nothing has changed: without claims, and if the start is refused and nothing
  /// is stopped
  bool control(franka_hw::ControlMode starts, franka_hw::ControlMode stops) noexcept;
  Switch switchResult() const noexcept {
    return refused_ ? Switch::kRefused : waits_ ? Switch::kOngoing : Switch::kDone;
  }
  /// Whether a motion waits until the arm rests: no controller commands it yet.
  bool waits() const noexcept { return waits_; }
  /// The mode of the claims, connected or not.
  franka_hw::ControlMode mode() const noexcept { return mode_; }

  /// The external activation device. Pressed: brakes; commands have no effect until a recovery.
  void setUserStop(bool pressed) noexcept;
  /// Begins a recovery. @returns false while the user stop is pressed, the brakes are closed, or
  /// the arm stands beyond a limit after an error
  bool recover() noexcept;
  /// Whether a recovery still waits for standstill.
  bool recovering() const noexcept;
  /// Begins or ends the connection that controllers use for their commands.
  /// @returns false if controllers command the arm
  bool setConnected(bool connected) noexcept;

  /// The world was reset: a running motion starts again, in the next tick, at the arm's position.
  void worldWasReset() noexcept;
  /// The joints were moved to other positions: the arm holds there. Its controllers, which would
  /// move it back, are disconnected until they are restarted.
  void jointsWerePlaced() noexcept;

  franka_sim::ControlUnit& unit() noexcept { return unit_; }
  franka::RobotState& state() noexcept { return state_; }
  /// Written by the controllers.
  ArmCommands& commands() noexcept { return commands_; }
  /// The commands of this tick, which joint limits may change.
  ArmCommands& applied() noexcept { return applied_; }

  /// Thread-safe.
  bool userStopped() const noexcept { return user_stopped_.load(std::memory_order_relaxed); }
  bool connected() const noexcept { return connected_.load(std::memory_order_relaxed); }
  /// Whether the arm waits for franka_control/error_recovery. Thread-safe.
  bool needsRecovery() const noexcept { return faulty_.load(std::memory_order_relaxed); }
  /// Number of commands so far that were not finite. Thread-safe.
  std::uint64_t refusedCommands() const noexcept {
    return refused_commands_.load(std::memory_order_relaxed);
  }
  /// How errors ended the last motion, for the log. Called by one thread.
  const Abort& lastAbort() noexcept { return abort_.read(); }
  /// The reason of the last refusal. Thread-safe.
  Refusal refusal() const noexcept { return refusal_.load(std::memory_order_relaxed); }

 private:
  bool generates() const noexcept;
  bool canConnect() const noexcept;
  void connect() noexcept;
  void tryToStart() noexcept;
  void stopMotion() noexcept;
  void refuse(Refusal why) noexcept;
  void resetCommands() noexcept;
  void reportCondition() noexcept;
  const franka_core::RobotCommand* command() noexcept;
  void filter() noexcept;
  /// Updates the state that controllers read.
  void updateState() noexcept;
  void updateContacts() noexcept;

  franka_sim::ControlUnit unit_;
  franka_sim::ArmPlant& plant_;
  SimArmOptions options_;
  bool filter_is_fresh_{true};
  std::array<double, 7> tau_ext_filtered_{};
  std::array<double, 6> O_F_ext_filtered_{}, K_F_ext_filtered_{};
  franka::RobotState state_{};
  franka::Duration time_{};
  ArmCommands commands_, applied_;
  ArmCommands target_;  ///< the commands that `applied_` approaches
  int ticks_to_target_{1};
  franka_core::RobotCommand command_{};
  franka_hw::ControlMode mode_{franka_hw::ControlMode::None};
  franka_hw::ControlMode remaining_{franka_hw::ControlMode::None};  ///< without the new ones
  bool refused_{false};                                             ///< the last switch
  bool waits_{false};
  int ticks_waited_{0};
  std::atomic<bool> user_stopped_{false}, connected_{true}, faulty_{false};
  std::atomic<Refusal> refusal_{Refusal::kNone};
  std::atomic<std::uint64_t> refused_commands_{0};
  Abort last_abort_;
  realtime_tools::LatestValue<Abort> abort_;
};

}  // namespace franka_sim_mujoco
