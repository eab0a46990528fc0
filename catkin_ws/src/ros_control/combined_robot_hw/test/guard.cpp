// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "guard.h"

#include <rt_guard/rt_guard.h>

namespace guard {

std::size_t allocationsAndLocks(const std::function<void()>& action) {
  const rt_guard::Scope scope;
  action();
  return scope.allocations() + scope.locks();
}

}  // namespace guard
