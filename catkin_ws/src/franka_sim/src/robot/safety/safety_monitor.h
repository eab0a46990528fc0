// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/fixed_pointer.h>
#include <franka_sim/robot/limits.h>

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

#include "robot/configuration.h"
#include "robot/estimator/state_estimator.h"
#include "robot/safety/collisions.h"

namespace franka_sim {

/// Two errors of external torque control. Their rules are not published; these are chosen here.
///
/// force_control_safety_violation: an external torque on a joint exceeds what its motor can give,
/// whatever the collision thresholds are.
/// force_controller_desired_force_tolerance_violation: the link-side torque has missed the
/// commanded one by more than 10 Nm for 100 ms: the joint does not follow its command. Called by
/// one thread. Real-time safe.
class ForceWatch {
 public:
  void restart() noexcept { missed_ = 0; }

  /// One tick. All [Nm]. @param tau_ext external torque @param achieved link-side torque without
  /// gravity @param desired the one commanded for that tick @param range of the motors
  ErrorSet update(const std::array<double, 7>& tau_ext, const std::array<double, 7>& achieved,
                  const std::array<double, 7>& desired,
                  const std::array<double, 7>& range) noexcept;

 private:
  int missed_{0};  // [ticks]
};

/// The cuboids that the end effector must not enter, as GetCartesianLimit reports them
/// (protocol 3.2). Called by one thread. Real-time safe.
class VirtualWalls {
 public:
  static constexpr std::size_t kCount = 8;  ///< numbers 0 to 7 (chosen here: none published)

  /// @returns whether the number exists and the wall is valid: edges finite and not negative, a
  /// rigid frame.
  bool set(std::int32_t id, const franka_core::fci::CartesianLimit& wall) noexcept;
  /// nullptr if there is no such number.
  const franka_core::fci::CartesianLimit* get(std::int32_t id) const noexcept;

  /// Call when a motion begins: an end effector that is inside a wall may move out.
  /// @param O_T_EE 4x4 column-major
  void begin(const std::array<double, 16>& O_T_EE) noexcept;
  /// Whether the origin of EE is inside an active wall, deeper than allowed.
  bool violated(const std::array<double, 16>& O_T_EE) noexcept;

 private:
  static double depth(const franka_core::fci::CartesianLimit& wall,
                      const std::array<double, 16>& O_T_EE) noexcept;

  std::array<franka_core::fci::CartesianLimit, kCount> walls_{};
  std::array<double, kCount> allowed_{};  // depth [m]
};

/// Which collision thresholds are in effect: those of acceleration while a motion generator
/// accelerates and 100 ms after; else the nominal ones (decision 15). Called by one thread.
/// Real-time safe.
class ThresholdPhase {
 public:
  /// One tick.
  void step() noexcept {
    remaining_ = accelerating_ ? kTicks : (remaining_ > 0 ? remaining_ - 1 : 0);
    in_acceleration_ = remaining_ > 0;
  }
  /// Whether more than a tenth of an acceleration limit is commanded, from the next tick on.
  void setAccelerating(bool accelerating) noexcept { accelerating_ = accelerating; }
  /// Forgets earlier accelerations; the thresholds of this tick stay.
  void restart() noexcept {
    accelerating_ = false;
    remaining_ = 0;
  }
  /// Whether the thresholds of acceleration are in effect in this tick.
  bool inAcceleration() const noexcept { return in_acceleration_; }

 private:
  static constexpr int kTicks = 100;
  bool accelerating_{false}, in_acceleration_{false};
  int remaining_{0};
};

/// Checks each measured state: limits, collisions, self-collision, virtual walls, deviation from
/// the desired pose. Raises error flags in the state. Called by one thread. Real-time safe.
class SafetyMonitor {
 public:
  /// @param configuration, estimator, state outlive the monitor.
  SafetyMonitor(const Configuration& configuration, const StateEstimator& estimator,
                franka_core::RobotState& state) noexcept
      : configuration_(&configuration),
        estimator_(&estimator),
        state_(&state),
        self_collision_(configuration.parameters().has_hand) {}

  /// A motion begins at the measured pose: it may leave a present self-collision or virtual wall.
  void motionBegins() noexcept;
  /// Another control law acts from now on.
  void lawChanges() noexcept { force_watch_.restart(); }

  /// The checks in every mode: measured limits and collisions.
  void check(const MotionLimits& limits, const CollisionThresholds& thresholds) noexcept;
  /// The checks in a motion. @param motor_torques of the tick that led to this state [Nm]
  void checkMotion(const franka_core::fci::MoveRequest& motion, const MotionLimits& limits,
                   const std::array<double, 7>& motor_torques) noexcept;

  /// Raises the errors' flags in the state.
  void raise(const ErrorSet& errors) noexcept { errors.addTo(state_->errors); }
  void clearCollisions() noexcept { joint_collision_ = cartesian_collision_ = Collision(); }
  const Collision& jointCollision() const noexcept { return joint_collision_; }
  const Collision& cartesianCollision() const noexcept { return cartesian_collision_; }
  const LinkPair& selfCollision() const noexcept { return self_collision_.overlappingPair(); }
  VirtualWalls& walls() noexcept { return walls_; }
  const VirtualWalls& walls() const noexcept { return walls_; }

 private:
  bool movesAgainstProfile(const franka_core::fci::MoveRequest& motion,
                           const MotionLimits& limits) const noexcept;

  FixedPointer<const Configuration> configuration_;
  FixedPointer<const StateEstimator> estimator_;
  FixedPointer<franka_core::RobotState> state_;
  Collision joint_collision_, cartesian_collision_;
  ForceWatch force_watch_;
  SelfCollision self_collision_;
  VirtualWalls walls_;
};

/// Which of the last 100 ticks of a motion had a command: control_command_success_rate
/// (protocol 5.3). Called by one thread. Real-time safe.
class CommandWindow {
 public:
  static constexpr std::size_t kSlots = 100;

  void record(bool received) noexcept;
  /// Fraction received of the ticks seen so far, at most the last 100; zero before the first.
  double rate() const noexcept;
  void clear() noexcept;

 private:
  std::bitset<kSlots> received_;
  std::size_t next_{0};
  std::size_t seen_{0};
};

/// Counts received and lost commands of a motion (protocol 5.3). Called by one thread.
/// Real-time safe.
class LossMonitor {
 public:
  /// This many lost commands in a row end a motion.
  static constexpr int kLostInARow = 20;

  /// One tick. Before a motion's first command nothing counts as lost: the client receives states
  /// without answering while it starts (protocol 5.2). @param patience ticks to wait for that first
  /// command @returns whether the client is lost.
  bool record(bool received, int patience = kPatience) noexcept;
  double rate() const noexcept { return window_.rate(); }
  void restart() noexcept;

 private:
  static constexpr int kPatience = 1000;  // [ticks], chosen here: the client's own UDP timeout

  CommandWindow window_;
  int lost_{0};
  bool begun_{false};
};

}  // namespace franka_sim
