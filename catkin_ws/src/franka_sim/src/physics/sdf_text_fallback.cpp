// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Used if Debian has no sdformat.
#include "physics/sdf_text.h"

namespace franka_sim::physics {

std::string expandSdf(const std::string& text, const SdfFiles& files, const std::string& title) {
  return expandByTinyXml(text, files, title);
}

}  // namespace franka_sim::physics
