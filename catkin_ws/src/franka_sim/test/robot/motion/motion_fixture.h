// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <ostream>
#include <string>

#include "../../support/arrays.h"
#include "../panda_arm.h"
#include "robot/motion/motion_generator.h"

namespace franka_core {

inline std::ostream& operator<<(std::ostream& out, RobotError error) {
  return out << indexOf(error);
}

}  // namespace franka_core

namespace franka_sim {

/// The flags' numbers.
inline std::ostream& operator<<(std::ostream& out, const ErrorSet& errors) {
  std::array<bool, franka_core::kErrorCount> flags{};
  errors.addTo(flags);
  for (std::size_t i = 0; i < flags.size(); i++) {
    out << (flags[i] ? " " + std::to_string(i) : "");
  }
  return out;
}

inline ErrorSet setOf(std::initializer_list<franka_core::RobotError> errors) {
  ErrorSet set;
  for (const franka_core::RobotError error : errors) {
    set.add(error);
  }
  return set;
}

}  // namespace franka_sim

namespace franka_sim::test {

using franka_core::MotionGeneratorMode;
using franka_core::RobotCommand;
using Joints = std::array<double, 7>;
using Twist = std::array<double, 6>;

/// One protocol of each robot: FER, FR3 before system 5.9, FR3 with it (floats on the wire).
constexpr std::array<unsigned, 3> kProtocols{{5, 8, 10}};

inline const franka_core::ArmModel& model() {
  static const franka_core::ArmModel arm = pandaModel();
  return arm;
}

inline Transform forward(const Joints& q) {
  return model().pose(franka_core::ArmFrame::kEndEffector, q, kHandF_T_NE);
}

/// A value rounded to 32 bit float. Volatile: see src/robot/limits/motion_checks.h.
inline double asFloat(double value) {
  const volatile float narrow = static_cast<float>(value);
  return narrow;
}

inline RobotCommand jointPositions(const Joints& q) {
  RobotCommand command;
  command.q_c = q;
  return command;
}

inline RobotCommand jointVelocities(const Joints& dq) {
  RobotCommand command;
  command.dq_c = dq;
  return command;
}

inline RobotCommand pose(const Transform& O_T_EE) {
  RobotCommand command;
  command.O_T_EE_c = O_T_EE;
  return command;
}

inline RobotCommand twist(const Twist& O_dP_EE) {
  RobotCommand command;
  command.O_dP_EE_c = O_dP_EE;
  return command;
}

inline RobotCommand withElbow(RobotCommand command, double q3, double sign = -1.0) {
  command.valid_elbow = true;
  command.elbow_c = {{q3, sign}};
  return command;
}

inline RobotCommand finished(RobotCommand command) {
  command.motion_generation_finished = true;
  return command;
}

/// A motion generator with its arm.
struct Motion {
  Motion(unsigned protocol, MotionGeneratorMode mode, const Joints& q = kReady)
      : generator(franka_core::motionLimitsOfProtocol(protocol)) {
    start.mode = mode;
    start.q_d = q;
    start.F_T_EE = kHandF_T_NE;
    EXPECT_EQ(MotionStartResult::kStarted, generator.start(start, model()));
  }

  MotionStep step(const RobotCommand& command) { return generator.step(&command, model()); }
  MotionStep lose() { return generator.step(nullptr, model()); }
  const DesiredMotion& desired() const { return generator.desired(); }
  const franka_core::MotionLimits& limits() const { return generator.limits(); }

  MotionStart start;
  MotionGenerator generator;
};

inline Transform startPose() {
  return model().pose(franka_core::ArmFrame::kEndEffector, kReady, kHandF_T_NE);
}

inline Transform shifted(double x) {
  Transform pose = startPose();
  pose[12] += x;
  return pose;
}

}  // namespace franka_sim::test
