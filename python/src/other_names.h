// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// @file
/// The names of pylibfranka and panda-python in addition to those of pyfranka (docs/python.md).
/// Call with the interpreter's lock held.

namespace pyfranka {

namespace py = pybind11;

/// Pairs of names: ours, and that of another package.
using Names = std::vector<std::pair<const char*, const char*>>;

/// Adds attributes of a class or module under other names.
inline void alias(const py::object& owner, const Names& names) {
  for (const auto& [ours, other] : names) {
    owner.attr(other) = owner.attr(ours);
  }
}

/// Adds the values of an enumeration with their names in C++: Idle is also kIdle.
inline void aliasAsInCpp(const py::object& enumeration) {
  for (const auto& [name, value] : py::dict(enumeration.attr("__members__"))) {
    py::setattr(enumeration, ("k" + name.cast<std::string>()).c_str(), value);
  }
}

/// An argument under its other name; whatever else belongs to a definition stays.
template <typename Extra>
Extra renamed(Extra extra, const Names& names) {
  if constexpr (std::is_base_of_v<py::arg, Extra>) {
    for (const auto& [ours, other] : names) {
      if (std::string_view(extra.name) == ours) {
        extra.name = other;
        break;
      }
    }
  }
  return extra;
}

/// The docstring of a definition whose arguments have their other names.
inline const char* renamed(const char* /* doc */, const Names& /* names */) {
  return "The same; arguments with their names in other packages.";
}

/// Calls `define` once with our names of the arguments and once with each set of other names.
template <typename Define, typename... Extra>
void withNames(const std::vector<Names>& others, const Define& define, Extra... extra) {
  define(extra...);
  for (const Names& names : others) {
    define(renamed(extra, names)...);
  }
}

/// Defines a method whose arguments have other names too.
template <typename Type, typename Function, typename... Extra>
void defNamed(Type& type, const char* name, const std::vector<Names>& others,
              const Function& function, Extra... extra) {
  withNames(others, [&](const auto&... all) { type.def(name, function, all...); }, extra...);
}

}  // namespace pyfranka
