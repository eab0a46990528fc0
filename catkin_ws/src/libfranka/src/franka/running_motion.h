// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>

#include <exception>
#include <optional>
#include <string>

#include "franka/motion_log.h"
#include "franka/robot_impl.h"

namespace franka {

/// One motion on the robot, from the command Move to its second reply. The holder of the robot's
/// Operation drives it from one thread; send and receive neither allocate nor lock while the motion
/// runs.
class RunningMotion {
 public:
  /// Starts the motion; returns when the robot's states show it.
  /// @throws CommandException if the robot refuses, ControlException if it ends at once or another
  /// motion runs, NetworkException after Timeouts::command.
  RunningMotion(Robot::Impl& robot, const franka_core::fci::MoveRequest& request);
  ~RunningMotion();
  RunningMotion(const RunningMotion&) = delete;
  RunningMotion& operator=(const RunningMotion&) = delete;

  /// Answers the newest state. @throws what ended the motion, if receive or finish has told it.
  void send(const franka_core::RobotCommand& command);
  /// Waits for the next state. @throws ControlException if it shows that the motion has ended; from
  /// then on at once.
  const franka_core::RobotState& receive();
  /// Ends the motion with this command, which the robot gets until it stands still.
  /// @throws ControlException if the motion ends in another way.
  void finish(franka_core::RobotCommand command);
  /// Stops the robot, as far as it can be reached.
  void cancel() noexcept;

  /// Whether torques alone move the arm: then it is they that are finished, not a motion generator.
  bool isTorqueOnly() const noexcept {
    return request_.motion_generator_mode == franka_core::MotionGeneratorMode::kNone;
  }

 private:
  using Reply = franka_core::fci::Reply;

  void start();
  void awaitStart();
  void abandonStart() noexcept;
  bool isShown() const noexcept;
  void receiveState();
  void requireRunning() const;
  template <typename Function>
  void concludeWith(Function function);
  Reply lastReply();
  [[noreturn]] void throwEnd(const Reply& reply, const char* reflex_text);

  Robot::Impl& robot_;
  const franka_core::fci::MoveRequest request_;
  MotionLog log_;
  std::uint32_t id_{0};
  std::optional<Reply> early_end_;  // the second reply, where it came before the motion was shown
  std::exception_ptr end_;          // what was thrown because the motion has ended
  franka_core::RobotCommand sent_;
  bool connection_lost_{false};
};

}  // namespace franka
