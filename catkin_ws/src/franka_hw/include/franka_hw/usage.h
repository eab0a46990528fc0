// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string_view>

namespace franka_hw {

/// For the first line of a node's main(): prints what it is to whoever asks with -h or --help,
/// without a ROS master. @returns whether somebody did
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
