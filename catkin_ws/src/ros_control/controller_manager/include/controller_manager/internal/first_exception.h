// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <utility>

namespace controller_manager {
namespace internal {

/// Makes several calls, catches their exceptions, and rethrows the first one at the end.
/// Real-time safe. Exception: a call that throws.
class FirstException {
 public:
  template <class Call>
  void capture(Call&& call) {
    try {
      std::forward<Call>(call)();
    } catch (...) {
      if (!first_) {
        first_ = std::current_exception();
      }
    }
  }

  void rethrow() const {
    if (first_) {
      std::rethrow_exception(first_);
    }
  }

 private:
  std::exception_ptr first_;
};

}  // namespace internal
}  // namespace controller_manager
