// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace franka_sim {

/// Thrown for a file that does not exist. Its text is a sentence with the file's name.
class MissingFile : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace franka_sim
