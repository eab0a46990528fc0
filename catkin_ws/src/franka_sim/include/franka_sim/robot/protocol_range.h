// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace franka_sim {

/// Protocol versions that a robot speaks.
struct ProtocolRange {
  std::uint16_t oldest;  ///< included
  std::uint16_t newest;  ///< included
};

/// All versions of a robot's generation (decision 25). @param robot "fr3"; any other value is a
/// Panda
inline ProtocolRange protocolsOf(const std::string& robot) noexcept {
  return robot == "fr3" ? ProtocolRange{6, 10} : ProtocolRange{3, 5};
}

}  // namespace franka_sim
