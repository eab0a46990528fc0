// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <source_file.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace franka_test {

std::string sourceFile(const std::string& path) { return FRANKA_SOURCES "/" + path; }

std::string readSource(const std::string& path) {
  std::ifstream file(sourceFile(path));
  if (!file) {
    throw std::runtime_error("The tests need " + sourceFile(path) + ", which cannot be read.");
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace franka_test
