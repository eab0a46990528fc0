// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>

#include <optional>
#include <string>

#include "properties/stepped_robot.h"

namespace franka_sim::test {

/// The rules that hold whatever a robot is told to do. Each function returns the first rule that is
/// broken, or nothing.
class Invariants {
 public:
  /// @param robot outlives this.
  explicit Invariants(const SteppedRobot& robot);

  /// Carries out a step with all checks.
  std::string run(SteppedRobot& robot, const Step& step);

 private:
  /// What the rules about two ticks need of the first.
  struct Before {
    franka_core::RobotState state;
    UnitStatus status;
  };

  std::string afterAction(const Step& step, SteppedRobot::Answer answer, const Observation& before,
                          const franka_core::RobotState& last, const UnitStatus& was);
  std::string afterTick();
  std::string brokenStopRule() const;
  std::string brokenModeRule() const;
  std::string brokenMotionRule() const;
  std::string brokenAnswerRule();
  std::string brokenBrakeRule();
  bool errorCleared() const;
  void remember();

  const SteppedRobot& robot_;
  Before before_;
  franka_core::ArmLimits limits_;  // the widest ones of the versions so far
  unsigned actions_{0};            // since the tick before
  bool restarted_{false};          // since the tick before
  bool stays_idle_{false};         // since the tick before
  std::optional<bool> locked_;     // by the last lock or unlock, unless something else acted
  bool motion_runs_{false}, stop_runs_{false}, recovery_runs_{false};  // not answered yet
};

}  // namespace franka_sim::test
