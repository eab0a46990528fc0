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

/// One motion on the robot, from Move to its second reply. The holder of the robot's Operation
/// drives it from one thread.
class RunningMotion {
 public:
  /// Starts the motion; returns when the robot's states show it.
  /// @throws CommandException if the robot refuses, ControlException if it ends at once or another
  /// motion runs, NetworkException after Timeouts::command.
  RunningMotion(Robot::Impl& robot, const franka_core::fci::MoveRequest& request);
  ~RunningMotion();
  RunningMotion(const RunningMotion&) = delete;
  RunningMotion& operator=(const RunningMotion&) = delete;

  /// Answers the newest state. Real-time safe.
  /// @throws the end of the motion, if receive or finish has thrown it.
  void send(const franka_core::RobotCommand& command);
  /// Waits for the next state. @throws ControlException if it shows that the motion has ended, also
  /// in all later calls.
  const franka_core::RobotState& receive();
  /// Ends the motion with this command, which is repeated until the robot stands still.
  /// @throws ControlException if the motion ends in another way.
  void finish(franka_core::RobotCommand command);
  /// Stops the robot if it can be reached.
  void cancel() noexcept;

  /// Whether the motion has torques alone: then torques are marked finished, not a motion
  /// generator.
  bool isTorqueOnly() const noexcept {
    return request_.motion_generator_mode == franka_core::MotionGeneratorMode::kNone;
  }

 private:
  using Reply = franka_core::fci::Reply;

  void start();
  void awaitStart();
  void cancelStart() noexcept;
  bool isShown() const noexcept;
  void receiveState();
  void requireRunning() const;
  template <typename Function>
  void finishWith(Function function);
  Reply lastReply();
  /// @param end the state that showed the end.
  [[noreturn]] void throwEnd(const Reply& reply, const franka_core::RobotState& end,
                             const char* reflex_text);

  Robot::Impl& robot_;
  const franka_core::fci::MoveRequest request_;
  MotionLog log_;
  std::uint32_t id_{0};
  std::optional<Reply> early_end_;  // the second reply, if it came before a state showed the motion
  std::exception_ptr end_;          // the exception that ended the motion
  franka_core::RobotCommand sent_;
  Robot::Impl::Clock::time_point received_at_{};  // the newest state
  Robot::Impl::Clock::duration answer_time_{};    // of the last command
  bool connection_lost_{false};
};

}  // namespace franka
