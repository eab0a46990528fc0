// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>

namespace franka {

Frame operator++(Frame& frame, int) noexcept {
  const Frame before = frame;
  frame = static_cast<Frame>(static_cast<int>(frame) + 1);
  return before;
}

}  // namespace franka
