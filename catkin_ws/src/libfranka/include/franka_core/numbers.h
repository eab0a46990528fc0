// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace franka_core {

/// The finite number that the whole text is, with a decimal point in every locale. Blanks around it
/// and a plus sign are allowed, as in XML; anything else is refused. Thread-safe.
std::optional<double> readNumber(std::string_view text) noexcept;

/// The integer that a number is, if it is one from `least` to `most`; nothing for a fraction, for
/// what no integer can hold, and for NaN. A cast of these is undefined. Real-time safe.
/// Thread-safe.
std::optional<std::int64_t> wholeNumber(double value, std::int64_t least,
                                        std::int64_t most) noexcept;

/// A number with this many significant digits, and without zeros at the end (as %g of C), with a
/// decimal point in every locale. Thread-safe.
std::string numberText(double value, int digits = 6);

/// A number with this many decimals (as %f of C), with a decimal point in every locale.
/// Thread-safe.
std::string fixedText(double value, int decimals);

}  // namespace franka_core
