// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/arm_model.h>
#include <franka_core/robot_error.h>

#include <stdexcept>

int main() {
  try {
    franka_core::ArmModel::fromUrdf("");
  } catch (const std::invalid_argument&) {
    return 0;
  }
  return 1;
}
