// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include <franka_sim_mujoco/robot/plant.h>

namespace franka_sim_mujoco {

/// Proportional, integral, derivative gains of one finger [N/m, N/(m s), N s/m].
struct FingerGains {
  double p{100.0}, i{0.0}, d{1.0};
};

struct GripperParameters {
  std::array<FingerGains, 2> gains;
  double max_width{0.08};             ///< [m]
  double move_tolerance{0.005};       ///< a move has arrived within this of its width [m]
  double resting_threshold{0.001};    ///< below this the fingers stand still [m/s]
  int consecutive_samples{3};         ///< ticks of standstill before it counts
};

/// How a command of the gripper ended.
enum class GripperOutcome {
  kRunning,
  kSucceeded,    ///< arrived, or holds an object within the epsilons
  kFailed,       ///< ended elsewhere than asked (obstacle, nothing or the wrong thing grasped)
  kInterrupted,  ///< another command or stop() came first
};

enum class GripperState { kIdle, kHolding, kMoving, kGrasping };

/// The hand's controller: state machine and force law of both faces (FCI and ROS), stepped once a
/// millisecond by the thread that steps the world. Allocation-free, deterministic, throws nothing.
/// Widths are totals of both fingers [m], speeds of the width [m/s], forces the hand's total [N]:
/// each finger presses with half (decision 29).
class GripperUnit {
 public:
  explicit GripperUnit(const GripperParameters& parameters);

  /// Names a command; its outcome can be asked for until the next command of any kind has ended.
  using Ticket = std::uint64_t;

  Ticket homing() noexcept;
  /// @returns 0 when refused: not finite, negative speed, width outside [0, max_width].
  Ticket move(double width, double speed) noexcept;
  /// Drives towards `width` and beyond until an object resists; then holds with `force`.
  /// Succeeds when width - epsilon_inner < measured width < width + epsilon_outer.
  Ticket grasp(double width, double epsilon_inner, double epsilon_outer, double speed,
               double force) noexcept;
  /// Interrupts what runs and releases the force; the fingers stay where they are.
  Ticket stop() noexcept;

  GripperOutcome outcome(Ticket ticket) const noexcept;
  GripperState state() const noexcept;
  double width() const noexcept;      ///< measured at the last step [m]
  bool isGrasped() const noexcept;    ///< holds an object within the epsilons of the last grasp

  /// One tick. @param period [s] @returns force on each finger, positive opens [N].
  std::array<double, 2> step(const HandMeasurement& measurement, double period) noexcept;

  /// After a reset of the world: idle at the present width.
  void restart() noexcept;

 private:
  GripperParameters parameters_;
};

}  // namespace franka_sim_mujoco
