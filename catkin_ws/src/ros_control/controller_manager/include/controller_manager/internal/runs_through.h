// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdio>
#include <exception>

namespace controller_manager {
namespace internal {

/// Text of an exception, truncated; fixed size, because the loop must not allocate.
typedef std::array<char, 256> ExceptionText;

inline void copyText(const char* from, ExceptionText& to) {
  std::snprintf(to.data(), to.size(), "%s", from);
}

/// Makes the call and catches exceptions. Adds neither an allocation nor a lock to those of the
/// call.
/// @param[out] text of the exception @returns false if it threw
template <class Call>
bool runsThrough(Call&& call, ExceptionText& text) {
  try {
    call();
    return true;
  } catch (const std::exception& error) {
    copyText(error.what(), text);
  } catch (...) {
    copyText("an exception of unknown type", text);
  }
  return false;
}

}  // namespace internal
}  // namespace controller_manager
