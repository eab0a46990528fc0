// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// @file
/// The typed arguments of the operator's commands (command_table.h): how they are written, their
/// units and ranges, and how they are read.

namespace franka_sim::fci {

/// One argument of a line: one word, or several of the same kind.
struct Argument {
  enum class Kind { kChoice, kNumber, kInteger, kText };

  Kind kind;
  std::string words;  ///< as a user reads them: "on|off", "FX FY FZ", "INERTIA*9"
  std::size_t count{1};
  std::string unit;                  ///< of numbers
  double min{}, max{};               ///< of numbers; infinite if the handler decides
  std::uint64_t first{}, last{};     ///< range of integers
  std::vector<std::string> choices;  ///< words of which it is one
  bool optional{false};              ///< all of its words may be left out

  /// "[TX TY TZ]", for example.
  std::string usage() const;
  /// "TX TY TZ in Nm" or "SECONDS from 0 to 60 s", for example; empty without unit and range.
  std::string range() const;
};

/// Where the words of each argument begin; null for one that is left out.
using ArgumentWords = std::vector<const std::string*>;

/// An argument that a handler gets as a value of this type.
template <typename Value>
struct Parameter {
  Argument argument;
};

/// @name Kinds of arguments
/// @{
/// One of two words; true for the first.
Parameter<bool> either(const std::string& first, const std::string& second);
inline Parameter<bool> onOff() { return either("on", "off"); }
/// One of several words; the index of the word. In a usage a name can replace many words.
Parameter<std::uint64_t> choice(std::vector<std::string> choices, const std::string& name = "");
template <std::size_t kCount>
Parameter<std::uint64_t> choice(const std::array<std::string_view, kCount>& choices) {
  return choice(std::vector<std::string>(choices.begin(), choices.end()));
}
/// An integer from first to last.
Parameter<std::uint64_t> integer(std::string name, std::uint64_t first, std::uint64_t last);
/// A finite number from min to max.
Parameter<double> number(std::string name, std::string unit,
                         double min = -std::numeric_limits<double>::infinity(),
                         double max = std::numeric_limits<double>::infinity());
/// Finite numbers. @param names of all, such as "X Y Z", or one with the count, such as "Q*7"
template <std::size_t kCount>
Parameter<std::array<double, kCount>> numbers(std::string names, std::string unit) {
  Argument argument = number(std::move(names), std::move(unit)).argument;
  argument.count = kCount;
  return {std::move(argument)};
}
/// As many switches.
template <std::size_t kCount>
Parameter<std::array<bool, kCount>> switches() {
  Argument argument = onOff().argument;
  argument.words = "on|off*" + std::to_string(kCount);
  argument.count = kCount;
  return {std::move(argument)};
}
/// Any word.
Parameter<std::string> text(std::string name);
/// May be left out.
template <typename Value>
Parameter<std::optional<Value>> optional(Parameter<Value> parameter) {
  parameter.argument.optional = true;
  return {std::move(parameter.argument)};
}
/// @}

/// @name Reads one word of an argument
/// @param i number of the word within the argument
/// @throws std::invalid_argument with name, allowed values, unit and the word
/// @{
void readWord(const Argument& argument, std::size_t i, const std::string& word, bool& value);
void readWord(const Argument& argument, std::size_t i, const std::string& word, double& value);
void readWord(const Argument& argument, std::size_t i, const std::string& word,
              std::uint64_t& value);
void readWord(const Argument& argument, std::size_t i, const std::string& word, std::string& value);
/// @}

namespace internal {

template <typename Value>
struct ReadArgument {
  static Value read(const Argument& argument, const std::string* words) {
    Value value{};
    readWord(argument, 0, *words, value);
    return value;
  }
};

template <typename Value, std::size_t kCount>
struct ReadArgument<std::array<Value, kCount>> {
  static std::array<Value, kCount> read(const Argument& argument, const std::string* words) {
    std::array<Value, kCount> values;
    for (std::size_t i = 0; i < kCount; i++) {
      readWord(argument, i, words[i], values[i]);
    }
    return values;
  }
};

template <typename Value>
struct ReadArgument<std::optional<Value>> {
  static std::optional<Value> read(const Argument& argument, const std::string* words) {
    return words == nullptr ? std::nullopt
                            : std::make_optional(ReadArgument<Value>::read(argument, words));
  }
};

}  // namespace internal

/// The value of an argument. @param words its first word, or null if it is left out
/// @throws std::invalid_argument with name, allowed values, unit and the word
template <typename Value>
Value readArgument(const Argument& argument, const std::string* words) {
  return internal::ReadArgument<Value>::read(argument, words);
}

}  // namespace franka_sim::fci
