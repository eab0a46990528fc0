// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/finite.h>
#include <franka_core/numbers.h>
#include <franka_core/transform.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
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
bool isUnit(double length) noexcept { return std::abs(length - 1.0) <= kTransformTolerance; }

double productOfColumns(const Matrix& m, std::size_t i, std::size_t j) noexcept {
  return at(m, 0, i) * at(m, 0, j) + at(m, 1, i) * at(m, 1, j) + at(m, 2, i) * at(m, 2, j);
}

bool areRight(const Matrix& m, std::size_t i, std::size_t j) noexcept {
  return std::abs(productOfColumns(m, i, j)) <= kTransformTolerance;
}

double determinant(const Matrix& m) noexcept {
  return at(m, 0, 0) * (at(m, 1, 1) * at(m, 2, 2) - at(m, 1, 2) * at(m, 2, 1)) -
         at(m, 0, 1) * (at(m, 1, 0) * at(m, 2, 2) - at(m, 1, 2) * at(m, 2, 0)) +
         at(m, 0, 2) * (at(m, 1, 0) * at(m, 2, 1) - at(m, 1, 1) * at(m, 2, 0));
}

std::string lengthFault(const char* what, std::size_t i, double length) {
  return std::string(what) + " " + std::to_string(i + 1) + " of its rotation has the length " +
         numberText(length, 9) + " and must have the length 1 within " +
         numberText(kTransformTolerance);
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
  for (std::size_t i = 0; i < matrix.size(); i++) {
    if (!std::isfinite(matrix[i])) {
      return "its entry in row " + std::to_string(i % 4 + 1) + " and column " +
             std::to_string(i / 4 + 1) + " is " + numberText(matrix[i]) +
             " and must be a finite number";
    }
  }
  if (!hasExactBottomRow(matrix)) {
    return "its bottom row (entries 4, 8, 12 and 16 of a column-major matrix) is " +
           numberText(matrix[3]) + " " + numberText(matrix[7]) + " " + numberText(matrix[11]) +
           " " + numberText(matrix[15], 17) + " and must be exactly 0 0 0 1";
  }
  for (std::size_t i = 0; i < 3; i++) {
    if (!isUnit(columnLength(matrix, i))) {
      return lengthFault("column", i, columnLength(matrix, i));
    }
    if (!isUnit(rowLength(matrix, i))) {
      return lengthFault("row", i, rowLength(matrix, i));
    }
  }
  for (std::size_t i = 0; i < 3; i++) {
    const std::size_t j = (i + 1) % 3;
    if (!areRight(matrix, i, j)) {
      return "columns " + std::to_string(i + 1) + " and " + std::to_string(j + 1) +
             " of its rotation are not at right angles: their product is " +
             numberText(productOfColumns(matrix, i, j), 9) + " and must be 0 within " +
             numberText(kTransformTolerance);
    }
  }
  return determinant(matrix) > 0.0 ? "" : "it mirrors: the determinant of its rotation is -1";
}

}  // namespace franka_core
