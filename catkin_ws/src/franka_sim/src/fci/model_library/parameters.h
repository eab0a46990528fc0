// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>

#include <array>

namespace franka_sim::model_library {

constexpr std::size_t kLinkNumbers = 16 + 1 + 3 + 9;

/// Marks the block in the shared object's file, so that the server finds it.
constexpr std::array<char, 32> kMark{"franka_sim served arm parameter"};

/// The arm's parameters as laid out in the shared object: links 1 to 7 (origin, mass, center of
/// mass, inertia), then the flange.
struct Parameters {
  std::array<char, 32> mark;
  double numbers[7 * kLinkNumbers + 16];
};

template <typename Number, typename Each>
void visitLink(Number&& link, Each&& each) {
  for (auto& number : link.origin) {
    each(number);
  }
  each(link.mass);
  for (auto& number : link.com) {
    each(number);
  }
  for (auto& number : link.inertia) {
    each(number);
  }
}

}  // namespace franka_sim::model_library
