// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <utility>

/// The type of an expression is exactly this one.
#define EXPECT_TYPE(type, ...) \
  static_assert(std::is_same<type, decltype(__VA_ARGS__)>::value, #__VA_ARGS__)

/// One class derives from another.
#define EXPECT_BASE(base, derived) static_assert(std::is_base_of<base, derived>::value, #derived)

/// A value to call members on; for unevaluated expressions only.
template <class T>
T& of() noexcept;
