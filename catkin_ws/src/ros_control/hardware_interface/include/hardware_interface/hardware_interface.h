// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>

#include <exception>
#include <set>
#include <string>

namespace hardware_interface {

/// Base of hardware interfaces: the resources that controllers claim exclusively. Claims are made
/// while controllers are initialized, never in the control loop. Called by one thread at a time.
class HardwareInterface {
 public:
  virtual ~HardwareInterface() = default;

  /// Claims the named resource. Claiming twice equals claiming once.
  virtual void claim(std::string resource) { claims_.insert(resource); }

  /// Removes all claims.
  void clearClaims() { claims_.clear(); }

  /// The claimed resources, sorted.
  std::set<std::string> getClaims() const { return claims_; }

 private:
  std::set<std::string> claims_;
};

/// An error of a hardware interface or of one of its resources.
class HardwareInterfaceException : public std::exception {
 public:
  HardwareInterfaceException(const std::string& message) : message_(message) {}

  /// The sentence.
  const char* what() const noexcept override { return message_.c_str(); }

 private:
  std::string message_;
};

}  // namespace hardware_interface
