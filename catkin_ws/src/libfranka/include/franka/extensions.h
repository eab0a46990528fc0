// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

/// @file
/// What this library offers beyond the vendor's interface. Programs that stay away from this header
/// and from Robot::setControlOptions compile against either library.
///
/// Besides: an address may name a port, `"192.168.0.1:1337"`, for robots behind a relay and
/// simulated ones; without it the protocol's own port is used.

namespace franka {

/// Which callback of a motion with torques is called first in a cycle.
enum class CallbackOrder {
  kMotionFirst,  ///< libfranka up to 0.17; the default
  kControlFirst  ///< libfranka from 0.18
};

/// What the first value of a JointPositions or CartesianPose motion is filtered and limited
/// against.
enum class FirstCycleReference {
  kRobotState,  ///< q_d, O_T_EE_c of the state: libfranka up to 0.14; the default
  kCommand      ///< the value itself, which thus passes unchanged: libfranka from 0.15
};

/// Where versions of libfranka differ in what a control loop does. The defaults are those of 0.9.2.
/// (The third difference, `limit_rate`, true up to 0.9 and false since, is an argument of
/// Robot::control.)
struct ControlOptions {
  CallbackOrder callback_order = CallbackOrder::kMotionFirst;
  FirstCycleReference first_cycle_reference = FirstCycleReference::kRobotState;
};

/// How long a Robot waits before it gives up with a NetworkException. Each must be positive.
struct Timeouts {
  /// To connect: all attempts together, and again for the first state and the description.
  std::chrono::milliseconds connect{5000};
  /// For the next state, while one is waited for. Not counted: time in which this process does not
  /// run, and time in which a simulated robot in lock-step shows that it waits for another client.
  /// In a motion of a robot whose clock is not this machine's (a simulated one that waits for its
  /// client), `silence` holds instead: a busy machine may hold it up. A connection that closes
  /// ends every wait.
  std::chrono::milliseconds state{1000};
  /// For the answer to a command.
  std::chrono::milliseconds command{10000};
  /// For the answer to a command that may take the robot long: recovery, stop, the end of a motion,
  /// the download of a model. States must go on arriving meanwhile, at the latest every
  /// `silence`.
  std::chrono::milliseconds long_command{60000};
  /// Without a state for so long a robot counts as gone while the answer to a command is awaited.
  std::chrono::milliseconds silence{5000};
};

/// The timeouts of the Robots constructed from now on in this process. Any thread.
/// @throws std::invalid_argument for one that is not positive.
void setTimeouts(const Timeouts& timeouts);
/// What setTimeouts set, or the defaults. Any thread.
Timeouts timeouts();

}  // namespace franka
