// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

constexpr int kHandLink = 8;  ///< its frame: the flange turned by -45 degrees about z

/// Two parts of an arm that are close to each other: links 0 to 7, or kHandLink.
struct LinkPair {
  int first{0}, second{0};  ///< the two parts
  double distance{0.0};     ///< between their surfaces, negative inside each other [m]
};

}  // namespace franka_sim
