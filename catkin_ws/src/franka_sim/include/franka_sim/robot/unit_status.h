// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/safety/collision.h>
#include <franka_sim/robot/safety/collision_thresholds.h>
#include <franka_sim/robot/safety/link_pair.h>

namespace franka_sim {

/// Status of a control unit that is not part of franka_core::RobotState.
struct UnitStatus {
  bool brakes_closed{false};  ///< the joints are locked (UserStopped, Other, once the arm rests)
  bool close_brakes{false};   ///< the brakes' switch, whatever the mode
  bool user_stop_pressed{false};  ///< the button's state, whatever the mode
  bool fci_active{true};          ///< clients may control the arm
  bool measured{false};  ///< the arm was observed since the start or restart: motions can start
  /// Time must advance even if no client answers: the arm brakes or recovers.
  bool settling{false};
  /// No joint moves, or so slowly that a sensor would not see it.
  bool resting{false};
  /// The end of a motion or of a stop is answered only after the arm has come to rest.
  bool answers_at_rest{false};
  /// The thresholds of contact and collision in this tick.
  CollisionThresholds thresholds;
  /// The causes of joint_reflex and cartesian_reflex, until their recovery.
  Collision joint_collision, cartesian_collision;
  /// The links that came too close; valid after self_collision_avoidance_violation.
  LinkPair self_collision;
};

}  // namespace franka_sim
