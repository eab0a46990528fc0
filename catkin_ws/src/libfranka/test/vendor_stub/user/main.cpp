// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/exception.h>
#include <franka/robot.h>
#include <franka_core/diagnose_log.h>

#include <cstring>
#include <iostream>

int main() {
  try {
    const franka::Robot robot("127.0.0.1");
    return 1;
  } catch (const franka::NetworkException& error) {
    if (std::strcmp(error.what(), "this is the other libfranka") != 0) {
      return 2;
    }
  }
  std::vector<franka::Record> log(2);
  std::array<bool, 41> errors{};
  errors[6] = true;  // joint_reflex
  log.back().state.last_motion_errors = franka::Errors(errors);
  log.back().state.joint_collision[3] = 1.0;
  log.back().state.tau_ext_hat_filtered[3] = 25.0;
  const auto sentences = franka_core::diagnoseLog(log, 5);
  if (sentences.size() != 1) {
    return 3;
  }
  std::cout << sentences.front() << "\n";
  return sentences.front().find("joint 4 (external torque 25 Nm)") != std::string::npos ? 0 : 4;
}
