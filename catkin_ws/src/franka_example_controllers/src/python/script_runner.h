// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_core/spin_rule.h>
#include <franka_hw/franka_model_interface.h>

#include <memory>
#include <string>

#include "arm_commander.h"
#include "script_source.h"

namespace franka_example_controllers {

/// Runs a script in its own thread. The control loop passes it a state and waits for the command
/// for a limited time; the loop itself never takes the interpreter's lock and allocates nothing. A
/// script that does not return is interrupted, and abandoned with its thread if that does not help.
///
/// load() and the destructor are called outside the loop, all others by the loop's thread unless
/// another is named.
class ScriptRunner {
 public:
  /// @param waiting how loop and script wait for each other. Without sleep is worth it in simulated
  /// time, whose cycles follow each other at once; a robot's loop sleeps and leaves the processor.
  explicit ScriptRunner(franka_core::WaitMode waiting);
  ~ScriptRunner();
  ScriptRunner(const ScriptRunner&) = delete;
  ScriptRunner& operator=(const ScriptRunner&) = delete;

  /// Loads the script. @param limit of the time for it [s] @returns a sentence (with the traceback,
  /// if there is one) if it fails, else nothing
  std::string load(const ScriptSource& source, const franka_hw::FrankaModelHandle& model,
                   double limit);

  /// Runs the script's `starting`. @param limit of the loop's wait [s]
  /// @returns false if it failed or is late; reason() then gives the cause
  bool start(const franka::RobotState& state, double limit);
  /// Runs the script's `update`. @param period since the last cycle [s] @returns like start()
  bool update(const franka::RobotState& state, double period, double limit, ArmCommand& command);
  /// Starts the script's `stopping` without waiting for it; skips it while the script is busy.
  void stop();

  /// Why start() or update() returned false. Valid until start() is called again. Thread-safe.
  std::string reason() const;
  /// Interrupts a late script, and logs its position. Returns at once. Thread-safe.
  /// Not real-time safe.
  void interrupt();

 private:
  struct Shared;
  bool exchange(int order, const franka::RobotState& state, double period, double limit);
  bool awaitAnswer(double limit);
  std::shared_ptr<Shared> shared_;
};

}  // namespace franka_example_controllers
