// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim::physics {

/// The shorter physics step: half a millisecond holds a grasp, a whole one loses it (decision 58).
constexpr const char* kTimestep = "0.0005";
/// Larger values reduce the creep of a grasp; 100 holds for a minute.
constexpr const char* kImpratio = "100";
/// Between finger pad and graspable object: time constant of two steps, as stiff as is stable.
constexpr const char* kGraspSolref = "0.001 1";
constexpr const char* kGraspSolimp = "0.95 0.99 0.001 0.5 2";
/// Everything else: soft enough that an impact at 0.1 m/s peaks at 63 N, not 655 N.
constexpr const char* kContactSolref = "0.01 1";
constexpr const char* kContactSolimp = "0.9 0.95 0.001 0.5 2";
/// Joint stops, coupled fingers, brakes.
constexpr const char* kStopSolref = "0.004 1";
constexpr const char* kCouplingSolref = "0.002 1";
constexpr const char* kBrakeSolref = "0.002 1";
constexpr const char* kStiffSolimp = "0.9999 0.9999 0.001 0.5 2";
/// Normal and tangential friction; a grasp needs torsional friction too.
constexpr const char* kCondim = "3";
constexpr const char* kGraspCondim = "4";
constexpr double kTorsionalFriction = 0.005;  ///< MuJoCo's default [m]
constexpr double kRollingFriction = 0.0001;   ///< MuJoCo's default [m]
/// Rubber of the fingers, and any other link, if the URDF gives none (the fingers' value is that of
/// the robot description, the other Gazebo's default).
constexpr double kFingerFriction = 1.13;
constexpr double kLinkFriction = 1.0;

}  // namespace franka_sim::physics
