// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

namespace franka_sim {

/// @param hand "gripper" or "vacuum gripper" @param must what the parameter must be
/// @throws std::invalid_argument with a sentence unless the condition holds
inline void requireOf(const char* hand, bool condition, const char* name, const char* must) {
  if (!condition) {
    throw std::invalid_argument(std::string("The ") + hand + " cannot start: parameter " + name +
                                " must be " + must + ".");
  }
}

}  // namespace franka_sim
