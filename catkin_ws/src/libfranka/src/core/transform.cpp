// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/finite.h>
#include <franka_core/numbers.h>
#include <franka_core/transform.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <string>

namespace franka_core {

namespace {

using Matrix = std::array<double, 16>;

double at(const Matrix& m, std::size_t row, std::size_t column) noexcept {
  return m[4 * column + row];
}

bool hasExactBottomRow(const Matrix& m) noexcept {
  return m[3] == 0.0 && m[7] == 0.0 && m[11] == 0.0 && m[15] == 1.0;
}

// Lengths, not their squares: matrices with four digits such as 0.7071 must pass.
double lengthOf(double x, double y, double z) noexcept { return std::sqrt(x * x + y * y + z * z); }

double rowLength(const Matrix& m, std::size_t i) noexcept {
  return lengthOf(at(m, i, 0), at(m, i, 1), at(m, i, 2));
}

double columnLength(const Matrix& m, std::size_t i) noexcept {
  return lengthOf(at(m, 0, i), at(m, 1, i), at(m, 2, i));
}

// These comparisons are false for NaN.
bool isUnit(double length, double tolerance = kTransformTolerance) noexcept {
  return std::abs(length - 1.0) <= tolerance;
}

double productOfColumns(const Matrix& m, std::size_t i, std::size_t j) noexcept {
  return at(m, 0, i) * at(m, 0, j) + at(m, 1, i) * at(m, 1, j) + at(m, 2, i) * at(m, 2, j);
}

bool areRight(const Matrix& m, std::size_t i, std::size_t j,
              double tolerance = kTransformTolerance) noexcept {
  return std::abs(productOfColumns(m, i, j)) <= tolerance;
}

double determinant(const Matrix& m) noexcept {
  return at(m, 0, 0) * (at(m, 1, 1) * at(m, 2, 2) - at(m, 1, 2) * at(m, 2, 1)) -
         at(m, 0, 1) * (at(m, 1, 0) * at(m, 2, 2) - at(m, 1, 2) * at(m, 2, 0)) +
         at(m, 0, 2) * (at(m, 1, 0) * at(m, 2, 1) - at(m, 1, 1) * at(m, 2, 0));
}

/// The shortest translation of a matrix that is reported as row-major [m]. Chosen here: shorter
/// ones are rounding errors of a bottom row.
constexpr double kMinTranslation = 1e-4;

bool looksRowMajor(const Matrix& m) noexcept {
  return m[12] == 0.0 && m[13] == 0.0 && m[14] == 0.0 && m[15] == 1.0 &&
         lengthOf(m[3], m[7], m[11]) >= kMinTranslation;
}

std::string entryFault(const Matrix& m) {
  for (std::size_t i = 0; i < m.size(); i++) {
    if (!std::isfinite(m[i])) {
      return "its entry in row " + std::to_string(i % 4 + 1) + " and column " +
             std::to_string(i / 4 + 1) + " is " + numberText(m[i]) + " and must be a finite number";
    }
  }
  if (looksRowMajor(m)) {
    return "it looks row-major: its translation " + numberText(m[3]) + " " + numberText(m[7]) +
           " " + numberText(m[11]) +
           " is in its bottom row, which must be exactly 0 0 0 1. Give it column by column: the "
           "translation is entries 13 to 15";
  }
  if (!hasExactBottomRow(m)) {
    return "its bottom row (entries 4, 8, 12 and 16 of a column-major matrix) is " +
           numberText(m[3]) + " " + numberText(m[7]) + " " + numberText(m[11]) + " " +
           numberText(m[15], 17) + " and must be exactly 0 0 0 1";
  }
  return "";
}

std::string lengthFault(const char* what, std::size_t i, double length, double tolerance) {
  return std::string(what) + " " + std::to_string(i + 1) + " of its rotation has the length " +
         numberText(length, 9) + " and must have the length 1 within " + numberText(tolerance);
}

std::string columnFault(const Matrix& m, double tolerance) {
  for (std::size_t i = 0; i < 3; i++) {
    if (!isUnit(columnLength(m, i), tolerance)) {
      return lengthFault("column", i, columnLength(m, i), tolerance);
    }
  }
  return "";
}

std::string rowFault(const Matrix& m) {
  for (std::size_t i = 0; i < 3; i++) {
    if (!isUnit(rowLength(m, i))) {
      return lengthFault("row", i, rowLength(m, i), kTransformTolerance);
    }
  }
  return "";
}

std::string angleFault(const Matrix& m, double tolerance) {
  for (std::size_t i = 0; i < 3; i++) {
    const std::size_t j = (i + 1) % 3;
    if (!areRight(m, i, j, tolerance)) {
      return "columns " + std::to_string(i + 1) + " and " + std::to_string(j + 1) +
             " of its rotation are not at right angles: their product is " +
             numberText(productOfColumns(m, i, j), 9) + " and must be 0 within " +
             numberText(tolerance);
    }
  }
  return "";
}

std::string mirrorFault(const Matrix& m) {
  return determinant(m) > 0.0 ? "" : "it mirrors: the determinant of its rotation is -1";
}

std::string firstOf(std::initializer_list<std::string> faults) {
  const auto* const fault = std::find_if(faults.begin(), faults.end(),
                                         [](const std::string& text) { return !text.empty(); });
  return fault == faults.end() ? "" : *fault;
}

}  // namespace

bool isHomogeneousTransformation(const Matrix& matrix) noexcept {
  if (!hasExactBottomRow(matrix)) {
    return false;
  }
  for (std::size_t i = 0; i < 3; i++) {
    if (!isUnit(columnLength(matrix, i)) || !isUnit(rowLength(matrix, i))) {
      return false;
    }
  }
  return true;
}

bool isRigidTransform(const Matrix& matrix) noexcept {
  return allFinite(matrix) && isHomogeneousTransformation(matrix) && areRight(matrix, 0, 1) &&
         areRight(matrix, 1, 2) && areRight(matrix, 2, 0) && determinant(matrix) > 0.0;
}

std::string transformFault(const Matrix& matrix) {
  return firstOf({entryFault(matrix), columnFault(matrix, kTransformTolerance), rowFault(matrix),
                  angleFault(matrix, kTransformTolerance), mirrorFault(matrix)});
}

std::string roughTransformFault(const Matrix& matrix, double tolerance) {
  return firstOf({entryFault(matrix), columnFault(matrix, tolerance), angleFault(matrix, tolerance),
                  mirrorFault(matrix)});
}

}  // namespace franka_core
