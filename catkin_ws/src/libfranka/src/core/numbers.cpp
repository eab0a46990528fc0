// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace franka_core {

namespace {

std::string written(double value, std::chars_format format, int precision) {
  // The longest: the sign, all digits of the largest number, the point, the decimals.
  std::string text(
      static_cast<std::size_t>(std::numeric_limits<double>::max_exponent10 + 3 + precision), '\0');
  const auto [end, error] =
      std::to_chars(text.data(), text.data() + text.size(), value, format, precision);
  text.resize(error == std::errc() ? static_cast<std::size_t>(end - text.data()) : 0);
  return text;
}

}  // namespace

std::optional<double> readNumber(std::string_view text) noexcept {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    return std::nullopt;
  }
  text.remove_suffix(text.size() - 1 - text.find_last_not_of(kBlanks));
  text.remove_prefix(begin);
  // from_chars refuses a plus sign.
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  const char* const end = text.data() + text.size();
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data() + (plus ? 1 : 0), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

std::optional<std::int64_t> wholeNumber(double value, std::int64_t least,
                                        std::int64_t most) noexcept {
  constexpr double kBeyond = 9223372036854775808.0;  // 2^63: one more than the largest
  if (!(value >= -kBeyond && value < kBeyond) || value != std::trunc(value)) {
    return std::nullopt;
  }
  const auto whole = static_cast<std::int64_t>(value);
  return whole >= least && whole <= most ? std::optional(whole) : std::nullopt;
}

std::string numberText(double value, int digits) {
  return written(value, std::chars_format::general, digits);
}

std::string fixedText(double value, int decimals) {
  return written(value, std::chars_format::fixed, decimals);
}

}  // namespace franka_core
