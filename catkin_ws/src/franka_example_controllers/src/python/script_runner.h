// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_hw/franka_model_interface.h>

#include <memory>
#include <string>

#include "arm_commander.h"
#include "script_source.h"

namespace franka_example_controllers {

/// Runs a script in a thread of its own. The control loop hands it a state and waits for the
/// command no longer than it is told; the loop itself never takes the interpreter's lock and
/// allocates nothing. A script that does not come back is interrupted, and left behind with its
/// thread if even that does not help.
///
/// load() and the destructor are called outside the loop, everything else by the loop's thread
/// unless another is named.
class ScriptRunner {
 public:
  ScriptRunner();
  ~ScriptRunner();
  ScriptRunner(const ScriptRunner&) = delete;
  ScriptRunner& operator=(const ScriptRunner&) = delete;

  /// Loads the script. @param limit how long that may take [s]
  /// @returns a sentence (with the traceback, where there is one) when it fails, else nothing
  std::string load(const ScriptSource& source, const franka_hw::FrankaModelHandle& model,
                   double limit);

  /// Runs the script's `starting`. @param limit how long the loop waits [s]
  /// @returns false when it failed or is late; then reason() says why
  bool start(const franka::RobotState& state, double limit);
  /// Runs the script's `update`. @param period since the last cycle [s] @returns as start()
  bool update(const franka::RobotState& state, double period, double limit, ArmCommand& command);
  /// Lets the script's `stopping` run; does not wait for it, and leaves it out when the script is
  /// still busy.
  void stop();

  /// Why start() or update() returned false. Any thread, until start() is called again.
  std::string reason() const;
  /// Interrupts a script that is late, and logs where it was. From any thread but the loop's;
  /// returns at once.
  void interrupt();

 private:
  struct Shared;
  bool exchange(int order, const franka::RobotState& state, double period, double limit);
  bool awaitAnswer(double limit);
  std::shared_ptr<Shared> shared_;
};

}  // namespace franka_example_controllers
