// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/motion_limits.h>
#include <franka_core/robot_state.h>

#include <array>

#include "robot/laws/torque_command.h"
#include "robot/limits/error_set.h"
#include "robot/motion/command_filter.h"
#include "robot/motion/motion_generator.h"
#include "robot/safety/loss_monitor.h"

namespace franka_sim {

/// A motion that a client commands: the Move request, its generator, filters and torques, and the
/// count of its commands. Called by one thread. Real-time safe.
class ClientMotion {
 public:
  /// @param max_torque of the motors [Nm]
  ClientMotion(const franka_core::MotionLimits& limits,
               const std::array<double, 7>& max_torque) noexcept
      : generator_(limits), torque_(max_torque) {}

  /// Starts the generator, if the request has one. Nothing changes if that is refused.
  /// @param continued whether it may also start at a singular pose
  MotionStartResult start(const franka_core::fci::MoveRequest& request, bool continued,
                          const franka_core::RobotState& state,
                          const franka_core::ArmModel& model) noexcept;
  /// Filters begin at the desired motion of the state.
  void beginFilters(const franka_core::RobotState& state) noexcept { filter_.begin(state); }

  struct Step {
    ErrorSet errors;
    bool generated{false};  ///< desired() is new
    bool finished{false};   ///< by the client
  };
  /// One tick. @param command nullptr if none arrived @param reflexes whether lost commands and
  /// steps of torque are errors; without them, commands with torques that are not finite are lost
  Step step(const franka_core::RobotCommand* command, bool reflexes,
            const franka_core::ArmModel& model) noexcept;

  /// The client is lost: from now on, missing commands count.
  void clientIsLost() noexcept { request_.use_async_motion_generator = false; }
  /// Torques and counts belong to one motion.
  void clear() noexcept;
  /// From the next motion on.
  void setLimits(const franka_core::MotionLimits& limits) noexcept {
    generator_ = MotionGenerator(limits);
  }
  CommandFilter& filter() noexcept { return filter_; }

  const franka_core::fci::MoveRequest& request() const noexcept { return request_; }
  bool hasGenerator() const noexcept;
  bool hasExternalController() const noexcept;
  const DesiredMotion& desired() const noexcept { return generator_.desired(); }
  const std::array<double, 7>& torque() const noexcept { return torque_.value(); }  ///< [Nm]
  double successRate() const noexcept { return losses_.rate(); }
  const franka_core::MotionLimits& limits() const noexcept { return generator_.limits(); }

 private:
  franka_core::fci::MoveRequest request_;
  MotionGenerator generator_;
  CommandFilter filter_;
  TorqueCommand torque_;
  LossMonitor losses_;
};

}  // namespace franka_sim
