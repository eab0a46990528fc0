// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string_view>

namespace franka_hw {

/// For the first line of a node's main(): prints the usage if an argument is -h or --help. Needs no
/// ROS master. @returns whether the usage was printed
inline bool printsUsage(int argc, char** argv, const char* usage) {
  for (int i = 1; i < argc; i++) {
    const std::string_view argument = argv[i];
    if (argument == "-h" || argument == "--help") {
      std::puts(usage);
      return true;
    }
  }
  return false;
}

}  // namespace franka_hw
