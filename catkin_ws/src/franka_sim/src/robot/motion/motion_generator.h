// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/fci/commands.h>
#include <franka_core/limits.h>
#include <franka_core/robot_error.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/limits.h>

#include <array>
#include <cstddef>

#include "robot/motion/cartesian_motion.h"
#include "robot/motion/joint_motion.h"
#include "robot/transforms.h"

namespace franka_sim {

/// The highest rate of change in this tick from which the value still stops after `distance`, if
/// the rate decreases by `step` per tick: a velocity for a position, a deceleration for a velocity.
/// @param distance, step not negative. Real-time safe.
double landingRate(double distance, double step) noexcept;

/// Brings a desired motion to rest, each joint alone at its full acceleration and with its jerk
/// limit (decision 16): the stop after a reflex, lost packets, StopMove or the user stop. A joint
/// that is about to rest stops at once, whatever its jerk is. Called by one thread. Real-time safe.
class BrakeTrajectory {
 public:
  /// @param q_d, dq_d, ddq_d desired position, velocity and acceleration [rad, rad/s, rad/s^2];
  /// the last two count as 0 where they are not finite
  void start(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
             const std::array<double, 7>& ddq_d, const franka_core::ArmLimits& limits) noexcept;
  /// One tick (1 ms). At rest only ddq changes, to 0.
  void step() noexcept;

  bool atRest() const noexcept;
  const std::array<double, 7>& q() const noexcept { return q_; }      ///< [rad]
  const std::array<double, 7>& dq() const noexcept { return dq_; }    ///< [rad/s]
  const std::array<double, 7>& ddq() const noexcept { return ddq_; }  ///< [rad/s^2]

 private:
  std::array<double, 7> q_{}, dq_{}, ddq_{}, ddq_max_{};
  std::array<double, 7> change_{};  ///< of the acceleration in a tick [rad/s^2]
};

/// Brings an arm to rest: its desired motion brakes; after a reflex the arm then yields for a
/// limited time, so that it does not press on an obstacle (decision 16). Called by one thread.
/// Real-time safe.
class RestSequence {
 public:
  /// The behavior of the desired pose in a tick.
  enum class Step {
    kNone,    ///< nothing: the arm rests
    kBrakes,  ///< follows braking()
    kStops,   ///< the same, and comes to rest in this tick
    kYields,  ///< follows the measured pose
  };

  /// Brakes from a desired motion, as BrakeTrajectory.
  void brake(const std::array<double, 7>& q_d, const std::array<double, 7>& dq_d,
             const std::array<double, 7>& ddq_d, const franka_core::ArmLimits& limits) noexcept;
  /// The arm is held where it is.
  void finish() noexcept { phase_ = Phase::kReached; }

  /// One tick. @param reflex whether the arm brakes because of an error @param q, dq measured
  Step step(bool reflex, const std::array<double, 7>& q, const std::array<double, 7>& dq,
            const franka_core::ArmLimits& limits) noexcept;

  bool isBraking() const noexcept { return phase_ == Phase::kBraking; }
  bool isFinished() const noexcept { return phase_ == Phase::kReached; }
  const BrakeTrajectory& braking() const noexcept { return brake_; }
  /// Where the desired motion, which brakes, comes to rest [rad]. Takes as long as hundreds of
  /// steps.
  std::array<double, 7> restingPosition() const noexcept;

 private:
  enum class Phase { kBraking, kYielding, kReached };

  BrakeTrajectory brake_;
  Phase phase_{Phase::kReached};
  int ticks_{0};
};

/// The low-pass filters that clients up to protocol 5 can set for motion generators and torque
/// controller (SetFilters). First order (protocol 5.6); at 1000 Hz a signal passes unchanged.
/// Rotations are filtered along the shortest arc. Called by one thread. Real-time safe.
class CommandFilter {
 public:
  /// @returns whether all cutoffs are within 1 and 1000 Hz.
  bool set(const franka_core::fci::SetFiltersRequest& cutoffs) noexcept;
  /// Starts at q_d, O_T_EE_c and elbow_c of the state, at rest.
  void begin(const franka_core::RobotState& state) noexcept;
  /// Filters one command. Values that are not finite or no rigid transform pass unchanged, to be
  /// refused later.
  const franka_core::RobotCommand& apply(const franka_core::RobotCommand& command) noexcept;

 private:
  franka_core::fci::SetFiltersRequest cutoffs_;
  bool active_{false};
  franka_core::RobotCommand last_;
};

/// Moves the joints to a target that may change at any time (protocol 10's asynchronous motions).
///
/// Each joint alone runs the time-optimal motion under its limits of velocity and acceleration,
/// exact to the tick. The arm gets its mean over four ticks, which keeps the jerk limit as well
/// (four ticks are 2 ddq_max / dddq_max for both arms) and ends exactly on the target. Where the
/// arm's velocity limit shrinks towards a joint's end, so does the speed. Called by one thread.
/// Real-time safe.
class AsyncJointGenerator {
 public:
  /// Starts at rest at q [rad]. @param maximum_velocity positive [rad/s]; limited to the arm's
  /// limits.
  void start(const std::array<double, 7>& q,
             const std::array<double, 7>& maximum_velocity) noexcept;
  /// Target [rad]; finite, and reachable from position() within the limits (MotionGenerator).
  void setTarget(const std::array<double, 7>& target) noexcept { target_ = target; }
  /// Brakes to rest instead of moving to the target.
  void stop() noexcept { stopping_ = true; }
  /// One tick (1 ms) on.
  void step(const MotionLimits& limits) noexcept;

  /// Whether neither the motion nor its mean moves any more.
  bool atRest() const noexcept;
  const JointSample& sample() const noexcept { return sample_; }
  /// Position of the motion [rad], before the mean over the last ticks.
  const std::array<double, 7>& position() const noexcept { return q_; }

 private:
  static constexpr std::size_t kWindow = 4;

  std::array<double, 7> target_{}, maximum_velocity_{};
  std::array<double, 7> q_{}, dq_{};                      // before the mean
  std::array<std::array<double, 7>, kWindow> history_{};  // of q_, a ring
  std::size_t newest_{0};
  JointSample sample_;
  bool stopping_{false};
};

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
  explicit MotionGenerator(const MotionLimits& limits = motionLimitsOfProtocol(5)) noexcept;

  /// Starts a motion; desired() is then at rest at q_d. If refused, nothing changes.
  MotionStartResult start(const MotionStart& start, const franka_core::ArmModel& model) noexcept;

  /// One tick. @param model as given to start @param command nullptr when none arrived.
  MotionStep step(const franka_core::RobotCommand* command,
                  const franka_core::ArmModel& model) noexcept;

  const DesiredMotion& desired() const noexcept { return desired_; }
  const MotionLimits& limits() const noexcept { return limits_; }

 private:
  bool isCartesian() const noexcept;
  ErrorSet advanceAsync(const franka_core::RobotCommand* command) noexcept;
  ErrorSet advanceJoints(const franka_core::RobotCommand* command) noexcept;
  ErrorSet advanceCartesian(const franka_core::RobotCommand* command,
                            const franka_core::ArmModel& model) noexcept;
  void showJoints(const franka_core::ArmModel& model) noexcept;
  InverseKinematics::Solution solve(const CartesianSample& commanded,
                                    const franka_core::ArmModel& model) const noexcept;
  void showCartesian(const InverseKinematics::Solution& solution) noexcept;
  void showAcceleration() noexcept;

  MotionLimits limits_;
  MotionStart start_;
  JointMotion joints_;         // of joint commands, or after inverse kinematics
  CartesianMotion cartesian_;  // of Cartesian commands
  AsyncJointGenerator async_;
  DesiredMotion desired_;
  bool solved_{false};     // a Cartesian command has been solved in this motion
  bool finishing_{false};  // an asynchronous motion ends when at rest
};

}  // namespace franka_sim
