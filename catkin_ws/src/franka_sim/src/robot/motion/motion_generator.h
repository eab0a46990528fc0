// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/motion_limits.h>
#include <franka_core/robot_state.h>

#include <array>

#include "robot/limits/error_set.h"
#include "robot/motion/async_joint_generator.h"
#include "robot/motion/cartesian_motion.h"
#include "robot/motion/inverse_kinematics.h"
#include "robot/motion/joint_motion.h"
#include "robot/transforms.h"

namespace franka_sim {

/// Parameters of a motion's start.
struct MotionStart {
  franka_core::MotionGeneratorMode mode{franka_core::MotionGeneratorMode::kJointPosition};
  /// Last desired positions [rad]; O_T_EE_c and the elbow start at their forward kinematics.
  std::array<double, 7> q_d{};
  Transform F_T_EE{franka_core::kIdentityTransform};
  bool continued{false};     ///< after a stop: a Cartesian motion also starts at a singular pose
  bool asynchronous{false};  ///< point to point; joint positions only (protocol 10)
  std::array<double, 7> maximum_velocity{};  ///< of the asynchronous generator [rad/s]
};

enum class MotionStartResult {
  kStarted,
  kSingular,         ///< a Cartesian motion cannot start here (decision 12)
  kInvalidArgument,  ///< not a mode with a generator; asynchronous without joint positions or with
                     ///< velocities that are not finite and positive; q_d not finite
};

/// The desired motion in one tick: the fields of the same names of franka_core::RobotState. Poses
/// in O, twists of EE in O [m/s, rad/s], elbow (q3 [rad], sign).
struct DesiredMotion {
  std::array<double, 7> q_d{}, dq_d{}, ddq_d{};
  Transform O_T_EE_d{franka_core::kIdentityTransform}, O_T_EE_c{franka_core::kIdentityTransform};
  std::array<double, 6> O_dP_EE_d{}, O_dP_EE_c{}, O_ddP_EE_c{};
  std::array<double, 2> elbow_d{}, elbow_c{}, delbow_c{}, ddelbow_c{};
  bool near_singularity{false};  ///< inverse kinematics is damped: O_T_EE_d may lag O_T_EE_c
  bool accelerating{false};      ///< more than a tenth of an acceleration limit, in this tick alone
};

/// Result of one tick.
struct MotionStep {
  ErrorSet errors;       ///< why the command was refused; desired() is then that of the tick before
  bool finished{false};  ///< the client has finished the motion (with errors: while moving)
};

/// The robot's motion generators: turns one command a millisecond, or its absence, into the desired
/// motion, within the robot's limits.
///
/// Commands are checked against every rule (decisions 14, 47). If a command is lost the
/// acceleration is held, and the result is checked like a command (protocol 5.3). After an error
/// the motion is over: brake from desired() with BrakeTrajectory, then start again. A finish is
/// checked as a stop within one tick: a client that is too fast raises the flag of the acceleration
/// or jerk that this would take; an asynchronous motion brakes and finishes at rest.
///
/// Called by one thread. No function throws. Real-time safe.
class MotionGenerator {
 public:
  explicit MotionGenerator(
      const franka_core::MotionLimits& limits = franka_core::motionLimitsOfProtocol(5)) noexcept;

  /// Starts a motion; desired() is then at rest at q_d. If refused, nothing changes.
  MotionStartResult start(const MotionStart& start, const franka_core::ArmModel& model) noexcept;

  /// One tick. @param model as given to start @param command nullptr when none arrived.
  MotionStep step(const franka_core::RobotCommand* command,
                  const franka_core::ArmModel& model) noexcept;

  const DesiredMotion& desired() const noexcept { return desired_; }
  const franka_core::MotionLimits& limits() const noexcept { return limits_; }

 private:
  bool isCartesian() const noexcept;
  ErrorSet advanceAsync(const franka_core::RobotCommand* command) noexcept;
  ErrorSet advanceJoints(const franka_core::RobotCommand* command) noexcept;
  ErrorSet advanceCartesian(const franka_core::RobotCommand* command,
                            const franka_core::ArmModel& model) noexcept;
  void publishJoints(const franka_core::ArmModel& model) noexcept;
  InverseKinematics::Solution solve(const CartesianSample& commanded,
                                    const franka_core::ArmModel& model) const noexcept;
  void publishCartesian(const InverseKinematics::Solution& solution) noexcept;
  void publishAcceleration() noexcept;

  franka_core::MotionLimits limits_;
  MotionStart start_;
  JointMotion joints_;         // of joint commands, or after inverse kinematics
  CartesianMotion cartesian_;  // of Cartesian commands
  AsyncJointGenerator async_;
  DesiredMotion desired_;
  bool solved_{false};     // a Cartesian command has been solved in this motion
  bool finishing_{false};  // an asynchronous motion ends when at rest
};

}  // namespace franka_sim
