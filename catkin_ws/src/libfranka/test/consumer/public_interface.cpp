// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka/rate_limiting.h>
#include <franka/robot_state.h>
#include <franka_core/to_franka.h>

#include <iostream>

int main() {
  franka_core::RobotState from;
  from.message_id = 42;
  franka::RobotState to;
  franka_core::toFranka(from, to);
  std::cout << to << "\n";
  return to.time.toMSec() == 42 && !franka::Torques({1, 2, 3, 4, 5, 6, 7}).motion_finished ? 0 : 1;
}
