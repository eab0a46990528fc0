// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "arm_fixture.h"

namespace franka_sim::test {

using franka_core::ControllerMode;
using franka_core::MotionGeneratorMode;
using franka_core::RobotCommand;
using franka_core::RobotMode;
using franka_core::RobotState;
using Joints = std::array<double, 7>;
using Status = franka_core::fci::Status;

/// A unit with the settings of the FCI.
class FciTest : public ArmTest {
 protected:
  FciTest() {
    parameters = pandaOverFci();
    rebuild();
    test::tick(unit, arm);
  }

  /// A new unit on an arm at q.
  void standAt(const std::array<double, 7>& q) {
    rebuild();
    arm.put(q);
    run(3);
  }

  static CollisionThresholds highThresholds() {
    CollisionThresholds high;
    high.lower_torque.fill(1e6);
    high.upper_torque.fill(1e6);
    high.lower_force.fill(1e6);
    high.upper_force.fill(1e6);
    return high;
  }

  void ignoreCollisions() {
    ASSERT_EQ(Status::kSuccess, unit.request(collisionRequest(highThresholds(), highThresholds())));
  }

  void startMove(MotionGeneratorMode generator,
                 ControllerMode controller = ControllerMode::kJointImpedance) {
    ASSERT_EQ(Status::kMotionStarted, unit.request(moveRequest(generator, controller)));
    ASSERT_EQ(RobotMode::kMove, unit.state().robot_mode);
  }

  /// Runs ticks with commands made from the state; stops early when the motion is over.
  int drive(int ticks, const std::function<RobotCommand(int, const RobotState&)>& command) {
    for (int i = 0; i < ticks; i++) {
      const RobotState& state = unit.observe(arm.measure());
      const RobotCommand answer = command(i, state);
      arm.applyTorques(unit.actuate(&answer));
      arm.setBrakes(unit.status().brakes_closed);
      arm.step();
      if (unit.state().robot_mode != RobotMode::kMove) {
        return i + 1;
      }
    }
    return ticks;
  }

  /// A tick with changed sensor values.
  void tickWith(const std::function<void(ArmMeasurement&)>& change,
                const RobotCommand* command = nullptr) {
    ArmMeasurement m = arm.measure();
    change(m);
    unit.observe(m);
    arm.applyTorques(unit.actuate(command));
    arm.setBrakes(unit.status().brakes_closed);
    arm.step();
  }

  /// Ticks until the answer comes, or 6000 ticks have passed.
  std::optional<Status> waitFor(PendingAnswer which) {
    std::optional<Status> answer;
    for (int i = 0; i < 6000 && !answer; i++) {
      run(1);
      answer = unit.takeAnswer(which);
    }
    return answer;
  }

  /// The command of a client that stands still.
  static RobotCommand still(const RobotState& state) {
    RobotCommand command;
    command.q_c = state.q_d;
    command.O_T_EE_c = state.O_T_EE_c;
    command.elbow_c = state.elbow_c;
    return command;
  }

  std::vector<int> raised() const {
    std::vector<int> flags;
    for (std::size_t i = 0; i < franka_core::kErrorCount; i++) {
      if (unit.state().errors[i]) {
        flags.push_back(static_cast<int>(i));
      }
    }
    return flags;
  }
};

/// From 0 to 1 within a second, at rest at both ends including the acceleration.
inline double smoothStep(double t) {
  const double s = std::min(std::max(t, 0.0), 1.0);
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

/// The derivative of smoothStep.
inline double smoothSpeed(double t) {
  const double s = std::min(std::max(t, 0.0), 1.0);
  return 30 * s * s * (1 - s) * (1 - s);
}

}  // namespace franka_sim::test
