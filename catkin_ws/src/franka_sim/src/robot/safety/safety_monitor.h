// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/motion_limits.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/fixed_pointer.h>
#include <franka_sim/robot/safety/collision.h>

#include <array>

#include "robot/configuration.h"
#include "robot/estimator/state_estimator.h"
#include "robot/limits/error_set.h"
#include "robot/safety/force_watch.h"
#include "robot/safety/self_collision.h"
#include "robot/safety/virtual_walls.h"

namespace franka_sim {

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
  void check(const franka_core::MotionLimits& limits,
             const CollisionThresholds& thresholds) noexcept;
  /// The checks in a motion. @param motor_torques of the tick that led to this state [Nm]
  void checkMotion(const franka_core::fci::MoveRequest& motion,
                   const franka_core::MotionLimits& limits,
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
                           const franka_core::MotionLimits& limits) const noexcept;

  FixedPointer<const Configuration> configuration_;
  FixedPointer<const StateEstimator> estimator_;
  FixedPointer<franka_core::RobotState> state_;
  Collision joint_collision_, cartesian_collision_;
  ForceWatch force_watch_;
  SelfCollision self_collision_;
  VirtualWalls walls_;
};

}  // namespace franka_sim
