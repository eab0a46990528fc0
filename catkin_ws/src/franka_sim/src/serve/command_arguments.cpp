// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/serve/command_arguments.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace franka_sim::fci {

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : "|") + word;
  }
  return text;
}

// "FY" of "FX FY FZ", "INERTIA" of "INERTIA*9".
std::string nameOf(const Argument& argument, std::size_t i) {
  std::istringstream names(argument.words);
  std::string name;
  for (std::size_t k = 0; k <= i && names >> name; k++) {
  }
  return name.substr(0, name.find('*'));
}

std::size_t indexOf(const Argument& argument, const std::string& word) {
  const auto found = std::find(argument.choices.begin(), argument.choices.end(), word);
  if (found == argument.choices.end()) {
    throw std::invalid_argument("'" + word + "' is not one of " + joined(argument.choices) + ".");
  }
  return static_cast<std::size_t>(found - argument.choices.begin());
}

// Digits alone, since not every integer of 64 bits is a double; or another way to write one
// ("1e3").
std::optional<std::uint64_t> toInteger(const std::string& word) {
  std::uint64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc() && stop == end) {
    return value;
  }
  constexpr std::int64_t kLast = 1LL << 53;  // up to here doubles hold all integers
  const auto whole =
      franka_core::wholeNumber(franka_core::readNumber(word).value_or(-1.0), 0, kLast);
  return whole ? std::optional<std::uint64_t>(*whole) : std::nullopt;
}

// Bounds of an argument that has them.
std::string boundsOf(const Argument& argument) {
  if (argument.kind == Argument::Kind::kInteger) {
    return "from " + std::to_string(argument.first) + " to " + std::to_string(argument.last);
  }
  const bool limited = std::isfinite(argument.min) && std::isfinite(argument.max);
  return argument.kind != Argument::Kind::kNumber || !limited
             ? ""
             : "from " + franka_core::numberText(argument.min, 7) + " to " +
                   franka_core::numberText(argument.max, 7);
}

[[noreturn]] void refuse(const Argument& argument, std::size_t i, const std::string& kind,
                         const std::string& word) {
  const std::string bounds = boundsOf(argument);
  throw std::invalid_argument(
      nameOf(argument, i) + " must be " + kind + (bounds.empty() ? "" : " " + bounds) +
      (argument.unit.empty() ? "" : " [" + argument.unit + "]") + ", not '" + word + "'.");
}

}  // namespace

std::string Argument::range() const {
  const std::string bounds = boundsOf(*this);
  if (bounds.empty()) {
    return unit.empty() ? "" : words + " in " + unit;
  }
  return words + " " + bounds + (unit.empty() ? "" : " " + unit);
}

std::string Argument::usage() const { return optional ? "[" + words + "]" : words; }

Parameter<bool> either(const std::string& first, const std::string& second) {
  return {choice({first, second}).argument};
}

Parameter<std::uint64_t> choice(std::vector<std::string> choices, const std::string& name) {
  Argument argument{Argument::Kind::kChoice, name.empty() ? joined(choices) : name};
  argument.choices = std::move(choices);
  return {std::move(argument)};
}

Parameter<std::uint64_t> integer(std::string name, std::uint64_t first, std::uint64_t last) {
  Argument argument{Argument::Kind::kInteger, std::move(name)};
  argument.first = first;
  argument.last = last;
  return {std::move(argument)};
}

Parameter<double> number(std::string name, std::string unit, double min, double max) {
  Argument argument{Argument::Kind::kNumber, std::move(name)};
  argument.unit = std::move(unit);
  argument.min = min;
  argument.max = max;
  return {std::move(argument)};
}

Parameter<std::string> text(std::string name) { return {{Argument::Kind::kText, std::move(name)}}; }

void readWord(const Argument& argument, std::size_t /*i*/, const std::string& word, bool& value) {
  value = indexOf(argument, word) == 0;
}

void readWord(const Argument& argument, std::size_t i, const std::string& word, double& value) {
  const std::optional<double> number = franka_core::readNumber(word);
  if (!number || !(*number >= argument.min && *number <= argument.max)) {
    refuse(argument, i, boundsOf(argument).empty() ? "a finite number" : "a number", word);
  }
  value = *number;
}

void readWord(const Argument& argument, std::size_t i, const std::string& word,
              std::uint64_t& value) {
  if (argument.kind == Argument::Kind::kChoice) {
    value = indexOf(argument, word);
    return;
  }
  const std::optional<std::uint64_t> integer = toInteger(word);
  if (!integer || *integer < argument.first || *integer > argument.last) {
    refuse(argument, i, "a whole number", word);
  }
  value = *integer;
}

void readWord(const Argument& /*argument*/, std::size_t /*i*/, const std::string& word,
              std::string& value) {
  value = word;
}

}  // namespace franka_sim::fci
