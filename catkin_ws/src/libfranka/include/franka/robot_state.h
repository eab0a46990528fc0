// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/duration.h>
#include <franka/errors.h>

#include <array>
#include <ostream>

/// @file
/// The state of the robot, received once a millisecond.

namespace franka {

/// The robot's mode.
enum class RobotMode {
  kOther,                  ///< brakes closed, starting up, or busy with another task
  kIdle,                   ///< ready for a motion
  kMove,                   ///< a motion runs
  kGuiding,                ///< moved by hand
  kReflex,                 ///< stopped after an error; needs recovery
  kUserStopped,            ///< the user stop is pressed
  kAutomaticErrorRecovery  ///< recovering
};

/// One state of the robot.
///
/// Frames: O base, F flange, NE nominal end effector, EE end effector, K stiffness frame.
/// Transforms are 4x4, inertias 3x3, both column-major. A suffix `_d` marks desired, `_c` commanded
/// values. Copying does not throw. Real-time safe.
struct RobotState {
  std::array<double, 16> O_T_EE{};     ///< measured pose of EE in O
  std::array<double, 16> O_T_EE_d{};   ///< desired pose of EE in O
  std::array<double, 16> F_T_EE{};     ///< EE in the flange: F_T_NE * NE_T_EE
  std::array<double, 16> F_T_NE{};     ///< nominal end effector in the flange
  std::array<double, 16> NE_T_EE{};    ///< EE in the nominal end effector frame
  std::array<double, 16> EE_T_K{};     ///< K in EE
  double m_ee{};                       ///< mass of the end effector [kg]
  std::array<double, 9> I_ee{};        ///< its inertia about its center of mass, axes of F [kg m^2]
  std::array<double, 3> F_x_Cee{};     ///< its center of mass in F [m]
  double m_load{};                     ///< mass of the load [kg]
  std::array<double, 9> I_load{};      ///< its inertia about its center of mass, axes of F [kg m^2]
  std::array<double, 3> F_x_Cload{};   ///< its center of mass in F [m]
  double m_total{};                    ///< mass of end effector and load [kg]
  std::array<double, 9> I_total{};     ///< inertia of both about their center of mass [kg m^2]
  std::array<double, 3> F_x_Ctotal{};  ///< center of mass of both in F [m]
  std::array<double, 2> elbow{};       ///< position of joint 3 [rad], sign of joint 4 (+1 or -1)
  std::array<double, 2> elbow_d{};     ///< desired elbow
  std::array<double, 2> elbow_c{};     ///< commanded elbow
  std::array<double, 2> delbow_c{};    ///< its velocity [rad/s]; second value 0
  std::array<double, 2> ddelbow_c{};   ///< its acceleration [rad/s^2]; second value 0
  std::array<double, 7> tau_J{};       ///< measured link-side torques, gravity included [Nm]
  std::array<double, 7> tau_J_d{};     ///< desired torques without gravity [Nm]
  std::array<double, 7> dtau_J{};      ///< derivative of the measured torques [Nm/s]
  std::array<double, 7> q{};           ///< measured joint positions [rad]
  std::array<double, 7> q_d{};         ///< desired joint positions [rad]
  std::array<double, 7> dq{};          ///< measured joint velocities [rad/s]
  std::array<double, 7> dq_d{};        ///< desired joint velocities [rad/s]
  std::array<double, 7> ddq_d{};       ///< desired joint accelerations [rad/s^2]
  std::array<double, 7> joint_contact{};      ///< 1 above the lower torque threshold; clears
  std::array<double, 6> cartesian_contact{};  ///< 1 above the lower force threshold; clears; in K
  std::array<double, 7> joint_collision{};    ///< 1 above the upper torque threshold; latched
  std::array<double, 6>
      cartesian_collision{};  ///< 1 above the upper force threshold; latched; in K
  std::array<double, 7> tau_ext_hat_filtered{};  ///< external torques, low-pass filtered [Nm]
  std::array<double, 6> O_F_ext_hat_K{};  ///< wrench the robot exerts at K, axes of O [N, Nm]
  std::array<double, 6> K_F_ext_hat_K{};  ///< the same, axes of K [N, Nm]
  std::array<double, 6> O_dP_EE_d{};      ///< desired twist of EE in O [m/s, rad/s]
  std::array<double, 3> O_ddP_O{};        ///< gravity seen by the base, in O [m/s^2]
  std::array<double, 16> O_T_EE_c{};      ///< commanded pose of EE in O
  std::array<double, 6> O_dP_EE_c{};      ///< commanded twist of EE in O [m/s, rad/s]
  std::array<double, 6> O_ddP_EE_c{};     ///< commanded acceleration of EE in O [m/s^2, rad/s^2]
  std::array<double, 7> theta{};          ///< motor positions, seen behind the gears [rad]
  std::array<double, 7> dtheta{};         ///< motor velocities, seen behind the gears [rad/s]
  Errors current_errors{};                ///< errors active now
  Errors last_motion_errors{};            ///< errors that aborted the last motion
  double
      control_command_success_rate{};  ///< share of the last 100 commands received; 0 without loop
  RobotMode robot_mode = RobotMode::kUserStopped;  ///< mode of the robot
  Duration time{};  ///< robot clock, strictly increasing, 1 ms a state
};

/// Writes the mode's name in quotes, for example `"Idle"`.
std::ostream& operator<<(std::ostream& ostream, RobotMode robot_mode);

/// Writes the state as one JSON object; `time` in [ms]; numbers in the format the stream is set to,
/// `null` where a number is not finite. Not real-time safe.
std::ostream& operator<<(std::ostream& ostream, const RobotState& robot_state);

}  // namespace franka
