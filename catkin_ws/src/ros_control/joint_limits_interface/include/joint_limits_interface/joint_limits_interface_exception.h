// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

namespace joint_limits_interface {

/// Limits cannot be enforced: a value is missing, or there is no handle of that name.
class JointLimitsInterfaceException : public std::exception {
 public:
  JointLimitsInterfaceException(const std::string& message) : message_(message) {}

  /// The sentence.
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  std::string message_;
};

}  // namespace joint_limits_interface
