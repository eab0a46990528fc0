// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/numbers.h>
#include <pybind11/pybind11.h>
#include <pyfranka/arrays.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

/// @file
/// Arguments of functions of Python, with sentences for those that cannot be used. pybind11's own
/// message lists signatures instead. Call with the interpreter's lock held. All of them:
/// @throws pybind11::type_error for another type, std::invalid_argument for another value

namespace pyfranka {

/// A whole number; 1.0 is none, as in Python's range().
std::int64_t wholeNumber(const py::object& value, const char* name);

/// A finite number.
double number(const py::object& value, const char* name);

/// True or False, of Python or of numpy, or the numbers 1 and 0.
bool yesOrNo(const py::object& value, const char* name);

std::string text(const py::object& value, const char* name);

/// Numbers that are finite, as arrayOf takes them.
template <std::size_t size>
std::array<double, size> finite(const py::object& values, const char* name) {
  const std::array<double, size> array = arrayOf<size>(values, name);
  if (!std::all_of(array.begin(), array.end(), [](double value) { return std::isfinite(value); })) {
    throw std::invalid_argument(std::string(name) + " must be finite numbers.");
  }
  return array;
}

/// So many times True or False.
template <std::size_t size>
std::array<bool, size> switches(const py::object& values, const char* name) {
  std::array<bool, size> result{};
  if (!py::isinstance<py::iterable>(values) || py::len_hint(values) != size) {
    throw std::invalid_argument(std::string(name) + " needs " + std::to_string(size) +
                                " times True or False.");
  }
  std::size_t i = 0;
  for (const py::handle each : values) {
    result.at(i++) = yesOrNo(py::reinterpret_borrow<py::object>(each), name);
  }
  return result;
}

/// Numbers for a repr, such as "[0.1, -0.785]".
template <std::size_t size>
std::string shortText(const std::array<double, size>& values) {
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "[" : ", ") + franka_core::numberText(value, 4);
  }
  return text + "]";
}

/// An object of a class that is bound. @param what such as "a Snapshot"
template <typename Type>
Type& objectOf(const py::object& value, const char* name, const char* what) {
  if (!py::isinstance<Type>(value)) {
    throw py::type_error(std::string(name) + " must be " + what + ", not " +
                         std::string(py::repr(value)) + ".");
  }
  return value.cast<Type&>();
}

}  // namespace pyfranka
