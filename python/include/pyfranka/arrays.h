// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

/// @file
/// Conversion of arrays between C++ and numpy for the module pyfranka and for other bindings. Call
/// with the interpreter's lock held.

namespace pyfranka {

namespace py = pybind11;

/// Shapes of the fields: matrices get two dimensions, in their column-major storage.
enum class Shape { kVector, kMatrix3, kMatrix4, kJacobian, kMass };

/// A read-only numpy view of the values; `owner` keeps them alive.
template <std::size_t size>
py::array_t<double> view(const std::array<double, size>& values, Shape shape, py::handle owner) {
  constexpr py::ssize_t kItem = sizeof(double);
  py::ssize_t rows = 0;
  switch (shape) {
    case Shape::kVector:
      break;
    case Shape::kMatrix3:
      rows = 3;
      break;
    case Shape::kMatrix4:
      rows = 4;
      break;
    case Shape::kJacobian:
      rows = 6;
      break;
    case Shape::kMass:
      rows = 7;
      break;
  }
  const auto count = static_cast<py::ssize_t>(size);
  py::array_t<double> array =
      rows == 0
          ? py::array_t<double>({count}, {kItem}, values.data(), owner)
          : py::array_t<double>({rows, count / rows}, {kItem, rows * kItem}, values.data(), owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// A read-only numpy array with a copy.
template <std::size_t size>
py::array_t<double> copy(const std::array<double, size>& values, Shape shape) {
  auto* const kept = new std::array<double, size>(values);
  const py::capsule owner(kept,
                          [](void* data) { delete static_cast<std::array<double, size>*>(data); });
  return view(*kept, shape, owner);
}

/// The rows of the matrix that has so many elements among the robot's; 0: there is none.
constexpr py::ssize_t rowsOf(std::size_t size) {
  return size == 16 ? 4 : size == 9 ? 3 : size == 42 ? 6 : size == 49 ? 7 : 0;
}

/// Whether an array is a row of so many elements, or the robot's matrix of them.
inline bool hasShapeOf(const py::array& array, std::size_t size) {
  const auto count = static_cast<py::ssize_t>(size);
  const py::ssize_t rows = rowsOf(size);
  return (array.ndim() == 1 && array.shape(0) == count) ||
         (array.ndim() == 2 && rows > 0 && array.shape(0) == rows && array.size() == count);
}

/// Any sequence of real numbers, or a matrix, in the robot's column-major order.
/// @throws std::invalid_argument if it has another number of values, another shape or other values
template <std::size_t size>
std::array<double, size> arrayOf(const py::object& values, const char* name) {
  using Numbers = py::array_t<double, py::array::f_style | py::array::forcecast>;
  const auto given = py::array::ensure(values);
  const bool real = given && std::string_view("biuf").find(given.dtype().kind()) < 4;
  if (!real || static_cast<std::size_t>(given.size()) != size) {
    PyErr_Clear();
    throw std::invalid_argument(std::string(name) + " needs " + std::to_string(size) + " numbers" +
                                (real ? ", not " + std::to_string(given.size()) : "") + ".");
  }
  if (!hasShapeOf(given, size)) {
    const std::string rows = std::to_string(rowsOf(size));
    throw std::invalid_argument(
        std::string(name) + " needs " + std::to_string(size) + " numbers in a row" +
        (rowsOf(size) > 0 ? " or a matrix of " + rows + " rows" : "") + ", not another shape.");
  }
  const auto array = Numbers::ensure(given);
  if (!array) {
    throw py::error_already_set();
  }
  std::array<double, size> result;
  std::copy_n(array.data(), size, result.begin());
  return result;
}

}  // namespace pyfranka
