// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/active_control.h>

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "franka/robot_impl.h"
#include "franka/running_motion.h"

namespace franka {

/// A motion that the program drives; keeps the connection open and busy until it ends.
class ActiveControl::Motion {
 public:
  /// Starts the motion. First checks that no other operation runs.
  /// @param checked_request checks the arguments and returns the request that starts the motion.
  Motion(std::shared_ptr<Robot::Impl> robot,
         const std::function<franka_core::fci::MoveRequest()>& checked_request);
  ~Motion();

  bool needsTorques() const noexcept { return needs_torques_; }
  std::pair<RobotState, Duration> read();
  /// @param fill writes the command for a state, and returns whether it is the last one.
  template <typename Fill>
  void write(Fill fill);

 private:
  void requireRunning() const;
  void end() noexcept;

  std::shared_ptr<Robot::Impl> robot_;
  bool needs_torques_{false};
  std::optional<Robot::Impl::Operation> operation_;
  std::optional<RunningMotion> running_;
  franka_core::RobotCommand command_;
  std::optional<std::uint64_t> last_time_;
};

}  // namespace franka
