// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

/// @file
/// Additions to the vendor's interface. Programs without this header and Robot::setControlOptions
/// compile against either library.
///
/// Also, an address may include a port, `"192.168.0.1:1337"`, for robots behind a relay and
/// simulated ones; without it the protocol's own port is used.

namespace franka {

/// Which callback of a motion with torques is called first in a cycle.
enum class CallbackOrder {
  kMotionFirst,  ///< libfranka up to 0.17; the default
  kControlFirst  ///< libfranka from 0.18
};

/// The reference against which the first value of a JointPositions or CartesianPose motion is
/// filtered and limited.
enum class FirstCycleReference {
  kRobotState,  ///< q_d, O_T_EE_c of the state: libfranka up to 0.14; the default
  kCommand      ///< the value itself, which then passes unchanged: libfranka from 0.15
};

/// Differences between versions of libfranka in the control loop. The defaults are those of 0.9.2.
/// (The third difference, `limit_rate`, true up to 0.9 and false since, is an argument of
/// Robot::control.)
struct ControlOptions {
  CallbackOrder callback_order = CallbackOrder::kMotionFirst;  ///< which callback is called first
  FirstCycleReference first_cycle_reference = FirstCycleReference::kRobotState;  ///< see above
};

/// Timeouts of a Robot, after which it throws a NetworkException. Each must be positive.
struct Timeouts {
  /// For connecting: all attempts together, and again for the first state and the description.
  std::chrono::milliseconds connect{5000};
  /// For the next state. Not counted: time in which this process does not run, and time in which a
  /// simulated robot in lock-step shows that it waits for another client. `silence` applies
  /// instead to simulated robots, because load may delay them: robots and hands on this machine (a
  /// loopback address), and robots whose clock in a motion is not this machine's. A closed
  /// connection ends every wait at once.
  std::chrono::milliseconds state{1000};
  /// For the reply to a command.
  std::chrono::milliseconds command{10000};
  /// For the reply to a command that may take long: recovery, stop, the end of a motion, the
  /// download of a model. Meanwhile states must arrive at least every `silence`.
  std::chrono::milliseconds long_command{60000};
  /// A robot without a state for this time counts as lost while the reply to a command is awaited.
  std::chrono::milliseconds silence{5000};
};

/// Sets the timeouts of all Robots constructed later in this process. Thread-safe.
/// @throws std::invalid_argument for one that is not positive.
void setTimeouts(const Timeouts& timeouts);
/// The values of setTimeouts, or the defaults. Thread-safe.
Timeouts timeouts();

/// Whether a process that was forked may use the connections of the one that made them, as with the
/// vendor's library; the default. A daemon needs it. Only one of the processes may use a connection
/// then: each would receive the replies and states of the other one. If it is not allowed, calls
/// throw an InvalidOperationException there; pyfranka forbids it. In either case the connection
/// lasts until the process that made it, or the last that has it, ends it. Thread-safe.
void allowUseAfterFork(bool allowed) noexcept;

}  // namespace franka
