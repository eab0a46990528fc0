// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/whole_robot.h>
#include <franka_sim/serve/sim_robot.h>

/// @file
/// The switches of the operator, by the rules that the robot has (SafetyRules). All throw
/// std::runtime_error "CODE: Sentence." if a rule refuses it; those that open a port also when
/// another program has taken it: what it belongs to is off then. Used between ticks.

namespace franka_sim {

void setUserStop(WholeRobot& robot, bool pressed);
void setGuiding(WholeRobot& robot, bool active);
void setBrakes(WholeRobot& robot, bool closed);
void setFci(fci::SimRobot& robot, bool active);
void setPower(fci::SimRobot& robot, bool on);
void setEndEffectorPower(fci::SimRobot& robot, bool on);
/// @throws std::runtime_error "CODE: Sentence." for anything but Refusal::kNone
void requireAllowed(Refusal refusal);

}  // namespace franka_sim
