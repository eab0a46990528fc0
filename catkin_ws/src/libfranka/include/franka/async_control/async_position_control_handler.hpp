// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/active_control_base.h>
#include <franka/robot.h>

#include <franka/async_control/target_status.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// @file
/// Joint targets to which the robot plans its own motion (protocol 10).

namespace franka {

/// Moves the robot from one joint position to the next; a new target may be set at any time, also
/// during a motion. Failures are returned, not thrown. Called by one thread. Not real-time safe.
class AsyncPositionControlHandler {
 public:
  /// How targets are approached.
  struct Configuration {
    std::vector<double> maximum_joint_velocities;  ///< seven limits [rad/s]
    double goal_tolerance{0.001};  ///< a target is reached within this norm of joint angles [rad]
  };
  /// A handler, or the reason why there is none.
  struct ConfigurationResult {
    std::shared_ptr<AsyncPositionControlHandler> handler;  ///< null on failure
    std::optional<std::string> error_message;              ///< why there is none
  };
  /// The target.
  struct JointPositionTarget {
    std::vector<double> joint_positions;  ///< seven positions [rad]
  };
  /// Whether a target was sent.
  struct CommandResult {
    std::string motion_uuid;  ///< identifies this target in logs; empty on failure
    bool was_successful{false};                ///< whether it was sent
    std::optional<std::string> error_message;  ///< why not
  };
  /// Progress towards the last target.
  struct TargetFeedback {
    TargetStatus status{TargetStatus::kIdle};  ///< how far the motion is
    std::optional<std::string> error_message;  ///< why it was aborted
  };

  /// Joint velocities whose norm is below this count as rest [rad/s].
  static constexpr double kRestVelocity = 0.01;

  /// Starts the motion under joint impedance control. The robot is busy until the handler is
  /// stopped or destroyed.
  static ConfigurationResult configure(const std::shared_ptr<Robot>& robot,
                                       const Configuration& configuration);
  ~AsyncPositionControlHandler();

  /// Sends a target in answer to the next state, for which it waits.
  CommandResult setJointPositionTarget(const JointPositionTarget& target);
  /// @param robot_state the newest state; without it the next one is awaited. A state of this
  /// motion in another mode than kMove shows that the motion has ended.
  TargetFeedback getTargetFeedback(const std::optional<RobotState>& robot_state = std::nullopt);
  /// Stops the robot and ends the motion.
  void stopControl();

 private:
  AsyncPositionControlHandler(std::unique_ptr<ActiveControlBase> motion, double goal_tolerance);
  void abort(const char* message);
  bool showsEnd(const RobotState& state) const;
  bool isReached(const RobotState& state) const;

  std::unique_ptr<ActiveControlBase> motion_;
  Duration started_at_;  // time of a state of the motion
  double goal_tolerance_;
  std::optional<std::array<double, 7>> target_;
  std::optional<std::string> abort_message_;
};

}  // namespace franka
