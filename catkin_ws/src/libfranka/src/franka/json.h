// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <ostream>

/// @file
/// Minimal JSON output for states; internal.

namespace franka {

/// A number, or `null` if it is not finite.
inline void writeJson(std::ostream& ostream, double value) {
  if (std::isfinite(value)) {
    ostream << value;
  } else {
    ostream << "null";
  }
}

/// A list of numbers.
template <std::size_t kSize>
void writeJson(std::ostream& ostream, const std::array<double, kSize>& values) {
  const char* separator = "[";
  for (double value : values) {
    ostream << separator;
    writeJson(ostream, value);
    separator = ",";
  }
  ostream << "]";
}

/// Name and value of a member after the first one.
template <typename Value>
void writeMember(std::ostream& ostream, const char* name, const Value& value) {
  ostream << ", \"" << name << "\": ";
  writeJson(ostream, value);
}

}  // namespace franka
