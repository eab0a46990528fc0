// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

namespace transmission_interface {

/// A transmission or its handle cannot be created, or there is no handle of that name.
class TransmissionInterfaceException : public std::exception {
 public:
  TransmissionInterfaceException(const std::string& message) : message_(message) {}

  /// The sentence.
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  std::string message_;
};

}  // namespace transmission_interface
